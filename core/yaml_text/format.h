// The canonical layout of a YAML file, comments and hand-made line breaks kept.
//
// Indentation by two blanks (lists below their key too), one blank after `:` and `,`, none inside
// brackets, two before a comment and one after its `#`, at most one empty line at a place, none at
// the ends. Items of `{}` and `[]` stay in the lines where they were; a further line begins below
// the first item, and a line longer than 160 bytes is broken at commas of the outermost bracket, so
// that the parts end before column 120. Numbers stand one blank before their unit (`16ms` becomes
// `16 ms`), single words lose their quotes, other texts keep them (as `"`, where that changes
// nothing).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/yaml/yaml.h"

namespace footfall::core {

// Formatting once and twice is the same. Nothing for what is not laid out here: complex keys (`?
// `), tabs, a text that is no YAML. The caller compares the trees (same_values) before it trusts
// it.
std::optional<std::string> format_yaml(std::string_view text);

// Whether two trees hold the same keys and values in the same order, blanks before units and
// quotes of single words aside.
bool same_values(const YamlNode& a, const YamlNode& b);

}  // namespace footfall::core
