// The text of a YAML file as tokens, comments among them: what a formatter needs and a parser
// drops.
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
    quoted,    // with its quotes; may hold line ends
    property,  // anchor, alias or tag
    colon,     // behind a key
    comma,
    open,     // { or [
    close,    // } or ]
    comment,  // with its #
    block,    // header of a | or > scalar; `lines` hold its text
    marker,   // `---`, `...`, a directive: the whole line
  };
  Kind kind = Kind::plain;
  std::string text;
  std::size_t offset = 0;            // of its first byte in the text
  std::size_t column = 0;            // from 0
  bool begins_line = false;          // nothing but blanks before it
  std::size_t empty_lines = 0;       // before its line, if it begins one
  std::vector<std::string> lines{};  // of a block scalar, its indentation taken off
};

// The tokens of a text without tabs in its indentation; nothing for complex keys (`? `), a quote or
// bracket that is never closed, a block scalar without a key or dash before it in its line.
std::optional<std::vector<YamlToken>> yaml_tokens(std::string_view text);

// A word that means the same with and without quotes.
bool is_plain_word(std::string_view text);
// `16ms` as `16 ms`; anything else as it is.
std::string spaced_quantity(const std::string& text);
// A quoted scalar (with its quotes) as the canonical layout writes it.
std::string canonical_quoted(std::string_view quoted);

}  // namespace footfall::core
