// Where a file uses which keys of its tables: for the tests that every key is used, and read.
#pragma once

#include <string>
#include <vector>

#include "core/yaml/key_table.h"
#include "core/yaml/yaml.h"

namespace footfall::tests {

struct KeyUse {
  std::string key;  // "task.reference"
  const core::KeySpec* spec = nullptr;
  const core::YamlNode* value = nullptr;
};

inline void collect_uses(const core::KeyTable& table, const core::YamlNode& map,
                         std::vector<KeyUse>& uses);

inline void collect_uses(const core::ValueSpec& spec, const core::YamlNode& value,
                         std::vector<KeyUse>& uses) {
  if (spec.map == nullptr) return;
  core::ValueSpec one = spec;
  if (spec.named) {
    one.named = false;
    for (const core::YamlEntry& entry : value.entries) collect_uses(one, entry.value, uses);
  } else if (value.is_map()) {
    collect_uses(*spec.map, value, uses);
  }
  for (const core::YamlNode& item : value.items) collect_uses(one, item, uses);
}

inline const core::KeyTable& owner_of(const core::KeyTable& table, std::string_view key) {
  for (const core::KeySpec& own : table.keys) {
    if (own.name == key) return table;
  }
  return table.more == nullptr ? table : owner_of(*table.more, key);
}

inline void collect_uses(const core::KeyTable& table, const core::YamlNode& map,
                         std::vector<KeyUse>& uses) {
  for (const core::YamlEntry& entry : map.entries) {
    const core::KeySpec* key = core::find_key(table, entry.key);
    if (key == nullptr) {
      if (table.others != nullptr) collect_uses(*table.others, entry.value, uses);
      continue;
    }
    const std::string owner(owner_of(table, entry.key).id);
    uses.push_back({owner + "." + entry.key, key, &entry.value});
    for (const core::ValueSpec& spec : key->values) collect_uses(spec, entry.value, uses);
  }
}

inline std::vector<KeyUse> key_uses(const core::FileTable& file, const core::YamlNode& root) {
  std::vector<KeyUse> uses;
  collect_uses(*file.root, root, uses);
  return uses;
}

// "table.key" of every key of a kind of file that no use is of.
inline std::vector<std::string> unused_keys(const core::FileTable& file,
                                            const std::vector<KeyUse>& uses) {
  std::vector<std::string> unused;
  for (const core::KeyTable* table : core::tables_of(file)) {
    for (const core::KeySpec& key : table->keys) {
      const std::string name = std::string(table->id) + "." + std::string(key.name);
      bool used = false;
      for (const KeyUse& use : uses) used = used || use.key == name;
      if (!used) unused.push_back(name);
    }
  }
  return unused;
}

// Texts and arguments of templates may be anything: nothing there is wrong.
inline bool may_be_anything(const KeyUse& use) {
  const core::ValueKind kind = use.spec->values[0].kind;
  return kind == core::ValueKind::text || kind == core::ValueKind::any;
}

// The text with a value on one line replaced by what no key takes: a map in a list in a list.
inline std::string broken(std::string text, const core::YamlNode& value) {
  std::size_t at = 0;
  for (int line = 1; line < value.mark.line; ++line) at = text.find('\n', at) + 1;
  at += static_cast<std::size_t>(value.mark.column) - 1;
  text.replace(at, value.scalar.size() + (value.quoted ? 2 : 0), "[[{wrong: 1}]]");
  return text;
}

}  // namespace footfall::tests
