// The canonical layout of a YAML file; keeps comments and manual line breaks.
//
// Indentation by two blanks (lists below their key too), one blank after `:` and `,`, none inside
// brackets, two before a comment and one after its `#`, at most one empty line in a row, none at
// the beginning and end. Items of `{}` and `[]` stay on their lines; a further line begins below
// the first item, and a line longer than 160 bytes is broken at commas of the outermost bracket, so
// that the parts end before column 120. Numbers are separated from their unit by one blank (`16ms`
// becomes `16 ms`), single words lose their quotes, other texts keep them (as `"` if that changes
// nothing).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/yaml/yaml.h"

namespace footfall::core {

// Idempotent. Returns nullopt for unsupported constructs: complex keys (`? `), tabs, invalid YAML.
// The caller must compare the trees (same_values) before using the result.
std::optional<std::string> format_yaml(std::string_view text);

// Whether two trees hold the same keys and values in the same order, ignoring blanks before units
// and quotes of single words.
bool same_values(const YamlNode& a, const YamlNode& b);

}  // namespace footfall::core
