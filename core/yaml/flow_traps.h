// Traps of YAML's braces and brackets that numbers fall into. Load time only.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/yaml/yaml.h"

namespace footfall::core {

// `{value: 3,5 cm}` is `value: 3` and a key `5 cm` without value. The quantity that was meant
// (`3.5 cm`), empty if the key is no such rest of `before`.
std::string split_quantity(const YamlEntry& before, const std::string& key);

// The item of `[100,5, 200]` that begins a decimal comma: two numbers with a comma and no blank
// between, while another comma of the list has one; nullptr if there is none.
const YamlNode* split_item(const YamlNode& list);

// A remark on a list with a wrong number of values, if two of them have a comma without a blank
// between.
std::string comma_hint(const YamlNode& list);

// Whether the plain scalar `value` that begins at `at` of the source is followed by a comment that
// was probably meant as a part of it: `step #{n}`, `foot #2`, `n is # {n}`.
bool is_cut(std::string_view source, std::size_t at, std::string_view value);

// A remark for an error in YAML, if a comment in this line (from 1 on) hides what would close its
// braces or brackets: `[{log: step #{n}}]`.
std::string comment_hint(std::string_view source, int line);

}  // namespace footfall::core
