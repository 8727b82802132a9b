// Text with styles: what a screen shows, before any terminal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace footfall::apps {

enum class Style { plain, dim, strong, title, selected, good, warning, bad, key, curve };

struct Span {
  std::string text;
  Style style = Style::plain;
};
using StyledLine = std::vector<Span>;

struct Picture {
  std::vector<StyledLine> lines;
  int cursor_row = -1, cursor_column = -1;  // of the text that is typed; -1: none
};

// Columns that a terminal takes for it: two for a wide sign, none for a combining one.
int text_columns(std::string_view text);
// In exactly that many columns: cut (the last is then `~`), or blanks behind; control characters
// and what is no UTF-8 as `?`.
std::string fitted(std::string_view text, int columns);
// The same, blanks in front.
std::string fitted_right(std::string_view text, int columns);
// The line in exactly that many columns, blanks in the style of the last span.
void fit_line(StyledLine& line, int columns);
// The text without styles.
std::string plain_text(const StyledLine& line);

}  // namespace footfall::apps
