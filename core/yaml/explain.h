// Origin of the values of a file: the files of its `base:` chain, edits, defaults.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/yaml/key_table.h"
#include "core/yaml/yaml.h"

namespace footfall::core {

// One value below the requested key.
struct ValueOrigin {
  std::string path;
  bool there = true;  // false if it was removed
  YamlNode value;
  std::vector<YamlChange> changes;  // changes of it or of a map that contains it, newest first
};

struct Explanation {
  std::string problem;              // reason why the key cannot be explained; empty if it can
  std::vector<ValueOrigin> values;  // the value, or all values of the map
  const KeySpec* key = nullptr;     // meaning and default in the key table; nullptr if absent
};

// Explains the value at a dotted path of keys (a key may contain dots). `table` is the schema of
// the root, nullptr below user-defined names and in files without schema.
Explanation explain(const YamlNode& root, const YamlHistory& history, const KeyTable* table,
                    std::string_view path);
// Adds the differences between two trees, before and after an edit, to `history`.
void add_differences(const YamlNode& before, const YamlNode& after, YamlHistory& history);

}  // namespace footfall::core
