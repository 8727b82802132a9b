// Checks and sanitizes text; see printable.h.
#include "core/text/printable.h"

#include <fmt/format.h>

#include <cstdint>

namespace footfall::core {

namespace {

// Length in bytes of the UTF-8 sequence at the beginning of `text`, 0 if invalid.
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

// Control characters other than those of `kept`, and invalid bytes, as `?`; at most `most` bytes.
std::string without_controls(std::string_view text, std::string_view kept, std::size_t most) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::string_view character = text.substr(0, length);
    // U+0080 to U+009F (bytes C2 80 to C2 9F) are control characters, too.
    const bool control =
        ((lead < 0x20 || lead == 0x7f) && kept.find(text[0]) == std::string_view::npos) ||
        (lead == 0xc2 && length == 2 && static_cast<unsigned char>(text[1]) < 0xa0);
    // U+FFFE and U+FFFF are no characters, and XML allows neither.
    const bool none = length == 0 || character == "\xef\xbf\xbe" || character == "\xef\xbf\xbf";
    const std::string_view piece = none || control ? "?" : character;
    if (out.size() + piece.size() > most) break;
    out += piece;
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

}  // namespace

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
  return without_controls(text, "", most);
}

std::string printable_lines(std::string_view text) {
  return without_controls(text, "\t\n", std::string_view::npos);
}

}  // namespace footfall::core
