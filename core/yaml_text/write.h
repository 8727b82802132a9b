// A tree as YAML text. Load-time tools only.
#pragma once

#include <string>

#include "core/yaml/yaml.h"

namespace footfall::core {

// In one line: `{a: 1, b: [x, y]}`.
std::string to_flow_yaml(const YamlNode& node);
// As a file: maps and lists in brackets where they fit in `width` bytes, else one entry a line. The
// root's entries always have lines of their own. Reading it gives the same tree, comments aside.
std::string to_yaml(const YamlNode& node, std::size_t width = 110);

}  // namespace footfall::core
