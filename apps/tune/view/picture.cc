// Styled text; see picture.h.
#include "apps/tune/view/picture.h"

#include <wchar.h>

#include <algorithm>

namespace footfall::apps {
namespace {

// One character: its bytes and its width in columns. Invalid UTF-8 is one byte, and not printable.
struct Sign {
  std::size_t bytes = 1;
  int columns = 1;
  bool shown = true;
};

Sign sign_at(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return {1, 1, first >= 0x20 && first != 0x7F};
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return {1, 1, false};
  unsigned code = first & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {1, 1, false};
    code = code << 6 | (byte(i) & 0x3F);
  }
  if (code < 0xA0) return {length, 1, false};  // C1 control characters, two bytes
  // The width of a character unknown to the locale is taken as one.
  const int columns = ::wcwidth(static_cast<wchar_t>(code));
  return {length, columns < 0 ? 1 : columns, true};
}

// As many complete characters as fit; `used`: their columns.
std::string taken(std::string_view text, int columns, int& used, bool& all) {
  std::string out;
  used = 0;
  while (!text.empty()) {
    const Sign sign = sign_at(text);
    if (used + sign.columns > columns) break;
    out += sign.shown ? std::string(text.substr(0, sign.bytes)) : "?";
    used += sign.columns;
    text.remove_prefix(sign.bytes);
  }
  all = text.empty();
  return out;
}

std::string cut(std::string_view text, int columns, int& used) {
  bool all = true;
  std::string out = taken(text, columns, used, all);
  if (all || columns < 1) return out;
  out = taken(text, columns - 1, used, all) + "~";
  ++used;
  return out;
}

std::string blanks(int count) {
  return std::string(static_cast<std::size_t>(std::max(0, count)), ' ');
}

}  // namespace

int text_columns(std::string_view text) {
  int columns = 0;
  while (!text.empty()) {
    const Sign sign = sign_at(text);
    columns += sign.columns;
    text.remove_prefix(sign.bytes);
  }
  return columns;
}

std::string fitted(std::string_view text, int columns) {
  int used = 0;
  std::string out = cut(text, std::max(0, columns), used);
  return out + blanks(columns - used);
}

std::string fitted_name(std::string_view text, int columns) {
  const int excess = text_columns(text) - columns;
  if (excess <= 0 || columns < 4) return fitted(text, columns);
  int used = 0;
  bool all = true;
  const std::string head = taken(text, (columns - 1) / 3, used, all);
  std::string_view tail = text;
  const int room = columns - 1 - used;
  while (text_columns(tail) > room) tail.remove_prefix(sign_at(tail).bytes);
  return fitted(head + "~" + std::string(tail), columns);
}

std::string fitted_right(std::string_view text, int columns) {
  int used = 0;
  const std::string out = cut(text, std::max(0, columns), used);
  return blanks(columns - used) + out;
}

void fit_line(StyledLine& line, int columns) {
  int left = columns;
  for (Span& span : line) {
    int used = 0;
    span.text = cut(span.text, std::max(0, left), used);
    left -= used;
  }
  if (left > 0) line.push_back({blanks(left), line.empty() ? Style::plain : line.back().style});
}

std::string plain_text(const StyledLine& line) {
  std::string text;
  for (const Span& span : line) text += span.text;
  return text;
}

}  // namespace footfall::apps
