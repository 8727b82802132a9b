// Where a value of a file comes from: the files of its `base:` chain, edits, defaults.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/yaml/key_table.h"
#include "core/yaml/yaml.h"

namespace footfall::core {

// One value below the key that was asked for.
struct ValueOrigin {
  std::string path;
  bool there = true;  // false: it was removed
  YamlNode value;
  std::vector<YamlChange> changes;  // to it or to what it is in, the last one first
};

struct Explanation {
  std::string problem;              // why there is nothing to say; empty: none
  std::vector<ValueOrigin> values;  // the value itself, or every value of the map that it is
  const KeySpec* key = nullptr;     // of the key's table: its meaning and default
};

// The value at a path of keys (dots between; a key may hold dots itself). `table` says what keys
// there could be; nullptr below names that are the author's own and in files without one.
Explanation explain(const YamlNode& root, const YamlHistory& history, const KeyTable* table,
                    std::string_view path);
// Adds to `history` what an edit of the whole tree replaced.
void add_differences(const YamlNode& before, const YamlNode& after, YamlHistory& history);

}  // namespace footfall::core
