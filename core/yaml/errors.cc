// Rewrites yaml-cpp's messages; see errors.h.
#include "core/yaml/errors.h"

#include <yaml-cpp/exceptions.h>

#include <array>
#include <string_view>

namespace footfall::core {

namespace {

struct PlainWords {
  std::string_view message;  // yaml-cpp's message, or its beginning
  std::string_view text;
};

namespace msg = YAML::ErrorMsg;
const std::array kPlainWords = {
    PlainWords{msg::END_OF_MAP_FLOW, "a '{' that is never closed, or a ',' missing before this"},
    PlainWords{msg::END_OF_SEQ_FLOW, "a '[' that is never closed, or a ',' missing before this"},
    PlainWords{msg::END_OF_MAP,
               "expected a key here, as deep as the ones before: is the indentation right, is "
               "everything above closed?"},
    PlainWords{msg::END_OF_SEQ,
               "expected a '-' here, as deep as the ones before: is the indentation right?"},
    PlainWords{msg::FLOW_END, "a ']' or '}' without its opening one"},
    PlainWords{msg::BLOCK_ENTRY, "a list item that cannot begin here: is the indentation right?"},
    PlainWords{msg::MAP_KEY, "a key that cannot stand here: is the line above complete?"},
    PlainWords{msg::MAP_VALUE,
               "a ':' that cannot stand here: quote a text with ': ', check the indentation"},
    PlainWords{msg::UNKNOWN_TOKEN, "a character that YAML keeps for itself: quote the text"},
    PlainWords{msg::UNKNOWN_ANCHOR,
               "'*' before a name is an alias in YAML: quote patterns, as in \"*knee\""},
    PlainWords{msg::ALIAS_NOT_FOUND,
               "'*' begins an alias in YAML: quote patterns, as in \"*knee\""},
    PlainWords{msg::CHAR_IN_ALIAS, "'*' begins an alias in YAML: quote patterns, as in \"*knee\""},
    PlainWords{msg::ANCHOR_NOT_FOUND, "'&' begins an anchor in YAML: quote the text"},
    PlainWords{msg::INVALID_ESCAPE,
               "unknown escape after '\\' in double quotes: write '\\\\' for a backslash"},
};

}  // namespace

std::string yaml_error_text(const std::string& message) {
  for (const PlainWords& words : kPlainWords) {
    if (message.starts_with(words.message)) return std::string(words.text);
  }
  return message;
}

}  // namespace footfall::core
