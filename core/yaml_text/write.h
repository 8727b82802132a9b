// A tree as YAML text. Load-time tools only.
#pragma once

#include <string>

#include "core/yaml/yaml.h"

namespace footfall::core {

// In one line: `{a: 1, b: [x, y]}`.
std::string to_flow_yaml(const YamlNode& node);
// As a file: maps and lists are in brackets if they fit in `width` bytes, else one entry a line.
// The root's entries always have their own lines. Reading it gives the same tree without comments.
std::string to_yaml(const YamlNode& node, std::size_t width = 110);

}  // namespace footfall::core
