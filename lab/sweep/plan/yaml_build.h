// Builds YAML trees in memory, for writing files and for command-line options.
#pragma once

#include <string>
#include <utility>

#include "core/yaml/yaml.h"

namespace footfall::lab {

inline core::YamlNode yaml_scalar(std::string text, core::Mark mark = {}) {
  core::YamlNode node;
  node.kind = core::YamlNode::Kind::scalar;
  node.scalar = std::move(text);
  node.mark = mark;
  return node;
}

inline core::YamlNode yaml_map(core::Mark mark = {}) {
  core::YamlNode node;
  node.kind = core::YamlNode::Kind::map;
  node.mark = mark;
  return node;
}

// Adds an entry, even if the key exists: readers report the duplicate.
inline void yaml_add(core::YamlNode& map, const std::string& key, core::YamlNode value) {
  const core::Mark mark = value.mark;
  map.entries.push_back({key, mark, false, std::move(value)});
}

// Sets the only entry with that key; returns its value.
inline core::YamlNode& yaml_put(core::YamlNode& map, const std::string& key, core::YamlNode value) {
  for (core::YamlEntry& entry : map.entries) {
    if (entry.key == key) return entry.value = std::move(value);
  }
  yaml_add(map, key, std::move(value));
  return map.entries.back().value;
}

}  // namespace footfall::lab
