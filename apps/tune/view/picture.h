// Styled text: the content of a screen, independent of a terminal.
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
  int cursor_row = -1, cursor_column = -1;  // cursor of a prompt; -1: none
};

// Width in terminal columns: two for a wide character, none for a combining one.
int text_columns(std::string_view text);
// Truncates (with `~` as last character) or pads to exactly that many columns; control characters
// and invalid UTF-8 become `?`.
std::string fitted(std::string_view text, int columns);
// Same for a dotted name, whose end tells it from its neighbours: truncated before the middle.
std::string fitted_name(std::string_view text, int columns);
// As fitted(), padded on the left.
std::string fitted_right(std::string_view text, int columns);
// Truncates or pads the line to exactly that many columns, in the style of the last span.
void fit_line(StyledLine& line, int columns);
// The text without styles.
std::string plain_text(const StyledLine& line);

}  // namespace footfall::apps
