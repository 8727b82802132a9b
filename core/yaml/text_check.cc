// Checks a YAML text before it is parsed; see text_check.h.
#include "core/yaml/text_check.h"

#include <algorithm>
#include <cstddef>
#include <string>

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

}  // namespace

bool check_text(std::string_view text, int file, Diagnostics& diagnostics) {
  constexpr int kMaxReports = 20;
  int reports = 0;
  int line = 1;
  while (!text.empty() && reports < kMaxReports) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view content = text.substr(0, end);
    if (const auto bad = find_bad_text(content)) {
      diagnostics.error({file, line, static_cast<int>(bad->offset) + 1}, "bad-text", bad->what);
      ++reports;
    } else if (const int column = tab_in_indentation(content); column > 0) {
      diagnostics.error({file, line, column}, "tab", "a tab in the indentation: use blanks");
      ++reports;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line;
  }
  return reports == 0;
}

}  // namespace footfall::core
