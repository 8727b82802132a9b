// What a YAML text must be before it is parsed, and how any text is printed. Not in a tick.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/diagnostics/diagnostics.h"

namespace footfall::core {

// Reports what yaml-cpp would take, or take wrongly, each at its place (the first of a line, at
// most 20): bytes that are not UTF-8 (ids "bad-text"), control characters, and tabs in the
// indentation
// ("tab"). True if there is nothing of the kind.
bool check_text(std::string_view text, int file, Diagnostics& diagnostics);

// Whether it is UTF-8 (no overlong forms, no surrogates) without control characters other than tab,
// line feed and carriage return.
bool is_plain_text(std::string_view text);

// The text with control characters as `\xHH`: what comes from a file must not break up a line.
std::string on_one_line(std::string_view text);

// What a stranger sent, for a terminal and a log: control characters and what is not UTF-8 as `?`,
// cut between characters at `most` bytes.
std::string printable(std::string_view text, std::size_t most);

}  // namespace footfall::core
