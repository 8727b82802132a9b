// Load-time problems, collected and printed like a compiler's: file:line:col: error: text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace footfall::core {

// A place in a text file; line and column count from 1, 0 is "the whole file".
struct Mark {
  int file = -1;  // index into Diagnostics' list of files
  int line = 0;
  int column = 0;
};

enum class Severity { error, warning };

// One problem. `id` is a stable short name (e.g. "unknown-key") that tests and docs refer to.
struct Diagnostic {
  Severity severity = Severity::error;
  Mark mark;
  std::string id;
  std::string text;
};

// Collects all problems of a load, so that one pass reports everything.
class Diagnostics {
 public:
  // Registers a file and returns its index; the same path gives the same index.
  int add_file(const std::string& path);
  void error(Mark mark, std::string_view id, std::string text);
  void warning(Mark mark, std::string_view id, std::string text);
  bool has_errors() const { return error_count_ > 0; }
  int error_count() const { return error_count_; }
  const std::vector<Diagnostic>& all() const { return items_; }
  const std::string& file(int index) const { return files_[static_cast<std::size_t>(index)]; }
  // In order of file and place; a problem that is reported again at its place is left out.
  std::vector<Diagnostic> sorted() const;
  // `file:line:col: error: text`, one a line, in order of file and place.
  std::string to_string() const;

 private:
  std::vector<std::string> files_;
  std::vector<Diagnostic> items_;
  int error_count_ = 0;
};

// The candidate nearest to `word` (edit distance at most 1/3 of its length, at least 1), or empty.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);
// " (did you mean 'x'?)" or "".
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace footfall::core
