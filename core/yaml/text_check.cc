// Checks a YAML text before it is parsed; see text_check.h.
#include "core/yaml/text_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/text/look_alike.h"
#include "core/text/printable.h"

namespace footfall::core {

namespace {

// 1-based column of a tab in a line's indentation, also behind "- "; 0 if there is none.
int tab_in_indentation(std::string_view line) {
  std::size_t tab = line.size();
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\t') {
      tab = std::min(tab, i);
    } else if (line[i] == '#' || line[i] == '\r') {
      return 0;  // comment line
    } else if (line[i] != ' ' && !(line[i] == '-' && i + 1 < line.size() &&
                                   (line[i + 1] == ' ' || line[i + 1] == '\t'))) {
      return tab < i ? static_cast<int>(tab) + 1 : 0;
    }
  }
  return 0;
}

// The name of the encoding of a file that is not UTF-8, empty if it may be.
std::string_view other_encoding(std::string_view text) {
  const auto starts = [&](std::string_view mark) { return text.starts_with(mark); };
  if (starts(std::string_view("\xff\xfe\0\0", 4))) return "UTF-32";
  if (starts(std::string_view("\0\0\xfe\xff", 4))) return "UTF-32";
  if (starts("\xff\xfe") || starts("\xfe\xff")) return "UTF-16";
  // Without a mark: Latin letters leave every other byte zero.
  if (text.size() < 4) return {};
  const bool little = text[0] != '\0' && text[1] == '\0' && text[2] != '\0' && text[3] == '\0';
  const bool big = text[0] == '\0' && text[1] != '\0' && text[2] == '\0' && text[3] != '\0';
  return little || big ? "UTF-16" : "";
}

// A problem of one line; `what` identifies its kind.
struct Problem {
  std::size_t offset = 0;
  std::string what;
  std::string advice;
};

bool is_key_byte(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '$' ||
         c == '*' || c == '-' || c == '+' || c == '"' || c == '\'' ||
         static_cast<unsigned char>(c) >= 0x80;
}

// The offset of a place where YAML needs a blank and where another character looks like one: in
// the indentation, and behind the ':' of a key or the '-' of an item.
std::optional<std::size_t> false_blank(std::string_view line) {
  constexpr std::size_t kLongest = 4;  // bytes of a character
  const auto looks_blank = [&](std::size_t at) {
    const auto found = find_look_alike(line.substr(at, kLongest));
    return found && found->offset == 0 && found->blank;
  };
  std::size_t at = 0;
  while (at < line.size() && (line[at] == ' ' || line[at] == '-')) ++at;
  if (at == line.size() || line[at] == '#') return std::nullopt;
  if (looks_blank(at)) return at;
  std::size_t word = at;  // where the key that is being read began
  bool flow = false;      // in braces or brackets, where a ',' is in front of a key
  for (; at < line.size(); ++at) {
    const char c = line[at];
    if ((c == '"' || c == '\'') && (at == word || line[at - 1] == ' ')) {
      at = line.find(c, at + 1);
      if (at == std::string_view::npos) return std::nullopt;
      continue;
    }
    if (c == '#' && at > 0 && line[at - 1] == ' ') return std::nullopt;
    if (c == ':' && at > word && at + 1 < line.size() && looks_blank(at + 1)) return at + 1;
    if (c == '{' || c == '[' || (flow && c == ',')) {
      flow = true;
      word = at + 1;
    } else if (c == ' ' && at == word) {
      ++word;
    } else if (!is_key_byte(c)) {
      word = line.size();  // a value
    }
  }
  return std::nullopt;
}

std::optional<Problem> problem_of(std::string_view line) {
  if (const auto bad = find_bad_text(line)) return Problem{bad->offset, bad->what, {}};
  const auto blank = false_blank(line);
  if (!blank) return std::nullopt;
  const auto character = find_look_alike(line.substr(*blank));
  return Problem{*blank, character->name,
                 fmt::format(" looks like a blank and is none: {}", character->advice)};
}

// The offset of a character behind a line's first word that looks like the ':' of a key.
std::optional<std::size_t> false_colon(std::string_view line) {
  const std::size_t word = line.find_first_not_of(" -");
  if (word == std::string_view::npos) return std::nullopt;
  const auto found = find_look_alike(line.substr(word));
  if (!found || found->offset == 0 || found->advice != "type ':'") return std::nullopt;
  const std::string_view key = line.substr(word, found->offset);
  const bool name = std::all_of(key.begin(), key.end(), is_key_byte);
  return name ? std::optional(word + found->offset) : std::nullopt;
}

// The indentation if the line opens a block of text (`doc: |`), -1 otherwise.
int text_block(std::string_view line) {
  const std::size_t end = line.find_last_not_of(" \r0123456789+-");
  if (end == std::string_view::npos || (line[end] != '|' && line[end] != '>')) return -1;
  if (end == 0 || line[end - 1] != ' ') return -1;
  return static_cast<int>(line.find_first_not_of(' '));
}

// Collects the problems of all lines, one of a kind.
class TextChecker {
 public:
  void take(std::string_view line, int number, int file) {
    const auto depth = static_cast<int>(std::min(line.find_first_not_of(' '), line.size()));
    const bool text =
        block_ >= 0 && (depth > block_ || line.find_first_not_of(" \r") == std::string_view::npos);
    if (!text) block_ = text_block(line);
    auto problem = problem_of(line);
    if (text && problem && !problem->advice.empty()) problem.reset();
    if (problem) {
      add(std::move(*problem), {file, number, 0});
    } else if (const int column = tab_in_indentation(line); column > 0) {
      tabs_.push_back({file, number, column});
    }
  }

  bool report(Diagnostics& diagnostics) const {
    constexpr std::size_t kMaxReports = 20;
    for (const Found& found : found_) {
      const std::string more = found.lines == 1 ? ""
                               : found.lines == 2
                                   ? " (and in another line)"
                                   : fmt::format(" (and in {} other lines)", found.lines - 1);
      diagnostics.error(found.mark, "bad-text", found.what + found.advice + more);
    }
    for (std::size_t k = 0; k < std::min(tabs_.size(), kMaxReports); ++k) {
      diagnostics.error(tabs_[k], "tab", "a tab in the indentation: use blanks");
    }
    return found_.empty() && tabs_.empty();
  }

 private:
  struct Found {
    Mark mark;
    std::string what, advice;
    int lines = 1;
  };

  // Invalid bytes are one kind: a file in another encoding has many of them.
  void add(Problem problem, Mark mark) {
    const std::string_view kind = std::string_view(problem.what).substr(0, kKindLength);
    const auto same = std::find_if(found_.begin(), found_.end(), [&](const Found& found) {
      return std::string_view(found.what).substr(0, kKindLength) == kind;
    });
    if (same != found_.end()) {
      ++same->lines;
      return;
    }
    mark.column = static_cast<int>(problem.offset) + 1;
    found_.push_back({mark, std::move(problem.what), std::move(problem.advice)});
  }

  static constexpr std::size_t kKindLength = 6;  // `U+00A0`, `not UT`, `a cont`
  std::vector<Found> found_;
  std::vector<Mark> tabs_;
  int block_ = -1;
};

}  // namespace

void make_line_ends_plain(std::string& text) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '\r' && (k + 1 == text.size() || text[k + 1] != '\n')) text[k] = '\n';
  }
}

bool check_text(std::string_view text, int file, Diagnostics& diagnostics) {
  if (const std::string_view encoding = other_encoding(text); !encoding.empty()) {
    diagnostics.error({file, 1, 1}, "bad-text",
                      fmt::format("{} text: save the file as UTF-8", encoding));
    return false;
  }
  TextChecker checker;
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  const bool marked = text.starts_with(kByteOrderMark);  // allowed at the very beginning
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::size_t skipped = line == 1 && marked ? kByteOrderMark.size() : 0;
    checker.take(text.substr(skipped, end - skipped), line, file);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return checker.report(diagnostics);
}

bool report_false_colon(std::string_view text, int failed_line, int file,
                        Diagnostics& diagnostics) {
  int number = 0, colon_line = 0;
  std::size_t colon = 0;
  for (std::size_t begin = 0; begin < text.size() && number < failed_line;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (const auto found = false_colon(line)) {
      colon_line = number;
      colon = *found;
    } else if (number < failed_line && line.find(": ") != std::string_view::npos) {
      colon_line = 0;  // YAML has read a key since
    }
  }
  if (colon_line == 0) return false;
  std::string_view line = text;
  for (int k = 1; k < colon_line; ++k) line.remove_prefix(line.find('\n') + 1);
  const auto character = find_look_alike(line.substr(colon));
  diagnostics.error(
      {file, colon_line, static_cast<int>(colon) + 1}, "bad-text",
      fmt::format("{} looks like a ':' and is none: {}", character->name, character->advice));
  return true;
}

}  // namespace footfall::core
