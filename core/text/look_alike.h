// Characters that look like others, or like nothing. Not for use in a tick.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace footfall::core {

struct LookAlike {
  std::size_t offset = 0;  // in bytes
  std::size_t length = 0;
  char32_t code = 0;
  std::string name;    // "U+00A0 (no-break space)"
  std::string advice;  // "type a blank"; empty if it depends
  bool blank = false;  // looks like a blank, or like nothing
};

// The first character that readers take for another one, or do not see at all: blanks other than
// the ordinary one, characters of no width, typographic dashes and quotes, the minus sign,
// full-width forms, letters of other alphabets with the shape of Latin ones.
std::optional<LookAlike> find_look_alike(std::string_view text);

// "; it has U+00A0 (no-break space): type a blank", or "" without such a character.
std::string look_alike_hint(std::string_view text);

// The text with the characters that look like blanks or like nothing left out, the others as
// typed on a keyboard where that is certain.
std::string without_look_alikes(std::string_view text);

// The character at `offset` of valid UTF-8 text, whole.
std::string_view character_at(std::string_view text, std::size_t offset);

}  // namespace footfall::core
