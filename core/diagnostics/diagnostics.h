// Load-time problems, collected and printed in the format of a compiler: file:line:col: error:
// text.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_set>
#include <vector>

namespace footfall::core {

struct Place {
  int file = -1;  // index into the file list of Diagnostics
  int line = 0;
  int column = 0;
  friend bool operator==(const Place&, const Place&) = default;
};

// A position in a text file; line and column count from 1, line 0 is the whole file.
struct Mark {
  int file = -1;  // index into the file list of Diagnostics
  int line = 0;
  int column = 0;
  // The place of a value that another text put here (a template's argument), which an error here
  // follows from; file -1: none.
  Place cause{};

  Place place() const { return {file, line, column}; }
  void set_cause(const Mark& mark) { cause = mark.cause.file >= 0 ? mark.cause : mark.place(); }
};

enum class Severity { error, warning };

// One problem. `id` is a stable short name (e.g. "unknown-key") used by tests and documents.
struct Diagnostic {
  Severity severity = Severity::error;
  Mark mark;
  std::string id;
  std::string text;
};

// Collects all problems of a load, so that one pass reports them all.
class Diagnostics {
 public:
  // Registers a file and returns its index; equal paths get the same index.
  int add_file(const std::string& path);
  // Adds an error. Repeats of the same text at the same position are dropped, because templates,
  // stacks and aliases may read one source line several times. An error with a cause is reported
  // there, once for each cause.
  void error(Mark mark, std::string_view id, std::string text);
  void warning(Mark mark, std::string_view id, std::string text);
  // Adds a problem as it is, of whichever severity.
  void add(const Diagnostic& item);
  // Suppresses further diagnostics at this position: they would only follow from an earlier one.
  void silence(Mark mark) { silent_.insert({mark.file, mark.line, mark.column}); }
  bool has_errors() const { return error_count_ > 0; }
  int error_count() const { return error_count_; }
  const std::vector<Diagnostic>& all() const { return items_; }
  int file_count() const { return static_cast<int>(files_.size()); }
  const std::string& file(int index) const { return files_[static_cast<std::size_t>(index)]; }
  // `file:line:col`, or what of it is known.
  std::string place_text(const Mark& mark) const;
  // Sorted by file and position, without repeated problems.
  std::vector<Diagnostic> sorted() const;
  // `file:line:col: error: text`, one problem a line, sorted by file and position.
  std::string to_string() const;

 private:
  bool is_new(Mark mark, std::string_view id, const std::string& text);
  bool move_to_cause(Mark& mark, std::string& text);

  std::vector<std::string> files_;
  std::vector<Diagnostic> items_;
  std::unordered_set<std::string> said_;  // position, id and text of every item
  std::set<std::tuple<int, int, int>> silent_;
  std::set<std::tuple<int, int, int>> causes_;  // with an error
  int error_count_ = 0;
};

}  // namespace footfall::core
