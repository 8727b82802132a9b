// Splits the text of a YAML file into tokens including comments, which a parser drops and a
// formatter needs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace footfall::core {

struct YamlToken {
  enum class Kind {
    dash,      // `- ` of a block list
    plain,     // one line of a plain scalar
    quoted,    // including quotes; may contain line ends
    property,  // anchor, alias or tag
    colon,     // behind a key
    comma,
    open,     // { or [
    close,    // } or ]
    comment,  // including its #
    block,    // header of a | or > scalar; `lines` hold its text
    marker,   // `---`, `...`, a directive: the whole line
  };
  Kind kind = Kind::plain;
  std::string text;
  std::size_t offset = 0;            // byte offset in the text
  std::size_t column = 0;            // from 0
  bool begins_line = false;          // only blanks before it
  std::size_t empty_lines = 0;       // number before its line, if it begins one
  std::vector<std::string> lines{};  // text of a block scalar without indentation
};

// The tokens of a text without tabs in its indentation; nullopt for complex keys (`? `), an
// unclosed quote or bracket, or a block scalar without a key or dash before it in its line.
std::optional<std::vector<YamlToken>> yaml_tokens(std::string_view text);

// A word that means the same with and without quotes.
bool is_plain_word(std::string_view text);
// `16ms` as `16 ms`; other text unchanged.
std::string spaced_quantity(const std::string& text);
// A quoted scalar (including quotes) in canonical layout.
std::string canonical_quoted(std::string_view quoted);

}  // namespace footfall::core
