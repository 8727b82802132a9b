// Detects and replaces text that must not be printed unchanged. Not for use in a tick.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace footfall::core {

struct BadText {
  std::size_t offset = 0;  // in bytes
  std::string what;
};

// The first place that is invalid UTF-8 (also overlong forms and surrogates) or a control character
// other than tab, line feed and carriage return; empty if there is none.
std::optional<BadText> find_bad_text(std::string_view text);

// Whether the text is valid UTF-8 (no overlong forms, no surrogates) without control characters
// other than tab, line feed and carriage return.
bool is_plain_text(std::string_view text);

// The text with control characters as `\xHH`, so that text from a file cannot break a line.
std::string on_one_line(std::string_view text);

// Sanitizes untrusted text for terminals, logs and XML: control characters, U+FFFE, U+FFFF and
// invalid bytes become `?`; truncated to `most` bytes at a character boundary.
std::string printable(std::string_view text, std::size_t most);

// The same for text of several lines: keeps tabs and line feeds, and all of it.
std::string printable_lines(std::string_view text);

}  // namespace footfall::core
