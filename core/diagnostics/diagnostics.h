// Load-time problems, collected and printed like a compiler's: file:line:col: error: text.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_set>
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
  // The same words about the same place are taken once: what is written once may be read often
  // (templates, stacks, aliases).
  void error(Mark mark, std::string_view id, std::string text);
  void warning(Mark mark, std::string_view id, std::string text);
  // What is said about this place from now on is a consequence of what was said already: dropped.
  void silence(Mark mark) { silent_.insert({mark.file, mark.line, mark.column}); }
  bool has_errors() const { return error_count_ > 0; }
  int error_count() const { return error_count_; }
  const std::vector<Diagnostic>& all() const { return items_; }
  int file_count() const { return static_cast<int>(files_.size()); }
  const std::string& file(int index) const { return files_[static_cast<std::size_t>(index)]; }
  // In order of file and place; a problem that is reported again at its place is left out.
  std::vector<Diagnostic> sorted() const;
  // `file:line:col: error: text`, one a line, in order of file and place.
  std::string to_string() const;

 private:
  bool is_new(Mark mark, std::string_view id, const std::string& text);

  std::vector<std::string> files_;
  std::vector<Diagnostic> items_;
  std::unordered_set<std::string> said_;  // place, id and text of every item
  std::set<std::tuple<int, int, int>> silent_;
  int error_count_ = 0;
};

// The candidate nearest to `word` (edit distance at most 1/3 of its length, at least 1), or empty.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);
// " (did you mean 'x'?)" or "".
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);
// The same; where no candidate is near, all of them if they are few: " (there are a, b)".
std::string did_you_mean_or_list(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace footfall::core
