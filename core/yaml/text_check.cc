// What a YAML text must be before it is parsed; see text_check.h.
#include "core/yaml/text_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace footfall::core {

namespace {

struct BadText {
  std::size_t offset = 0;  // in bytes
  std::string what;
};

// Bytes of the UTF-8 sequence at the beginning of `text`, 0 if it is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return 0;
  std::uint32_t code = lead & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0u) != 0x80u) return 0;
    code = (code << 6) | (byte(i) & 0x3fu);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return overlong || surrogate || code > 0x10ffff ? 0 : length;
}

// The first place that is not UTF-8 (also overlong forms and surrogates) or is a control character
// other than tab, line feed and carriage return; empty if there is none.
std::optional<BadText> find_bad_text(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const auto byte = static_cast<unsigned char>(text[at]);
    const std::size_t length = sequence_length(text.substr(at));
    if (length == 0) return BadText{at, fmt::format("not UTF-8 text (byte 0x{:02x})", byte)};
    const bool control =
        (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7f;
    if (control) return BadText{at, fmt::format("a control character (0x{:02x})", byte)};
    at += length;
  }
  return std::nullopt;
}

// A tab in a line's indentation, also behind "- ": 1-based column, 0 if there is none.
int tab_in_indentation(std::string_view line) {
  std::size_t tab = line.size();
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\t') {
      tab = std::min(tab, i);
    } else if (line[i] == '#' || line[i] == '\r') {
      return 0;  // nothing but a comment
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

bool is_plain_text(std::string_view text) { return !find_bad_text(text); }

std::string on_one_line(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  return out;
}

std::string printable(std::string_view text, std::size_t most) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const auto lead = static_cast<unsigned char>(text[0]);
    // U+0080 to U+009F are control characters, too: C2 80 to C2 9F.
    const bool control =
        lead < 0x20 || lead == 0x7f ||
        (lead == 0xc2 && length == 2 && static_cast<unsigned char>(text[1]) < 0xa0);
    const std::string_view piece = length == 0 || control ? "?" : text.substr(0, length);
    if (out.size() + piece.size() > most) break;
    out += piece;
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

}  // namespace footfall::core
