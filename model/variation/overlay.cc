// `variation:` of a file over that of its base; see variation.h.
#include <algorithm>

#include "core/yaml/value_reader.h"
#include "model/variation/variation.h"

namespace footfall::model {
namespace {

using core::is_off;
using core::KeyTable;
using core::YamlEntry;
using core::YamlNode;

YamlNode* find(YamlNode& map, std::string_view key) {
  const auto found = std::ranges::find(map.entries, key, &YamlEntry::key);
  return found == map.entries.end() ? nullptr : &found->value;
}

void erase(YamlNode& map, std::string_view key) {
  std::erase_if(map.entries, [key](const YamlEntry& entry) { return entry.key == key; });
}

// `off` of a map, as `off` of each of its keys: one of them can then be set again.
YamlNode each_off(const YamlNode& off, const KeyTable& table) {
  YamlNode map;
  map.kind = YamlNode::Kind::map;
  map.mark = off.mark;
  for (const core::KeySpec& key : table.keys) {
    map.entries.push_back({std::string(key.name), off.mark, false, off});
  }
  return map;
}

// `com: off` of all links, under the links that are named over it.
YamlNode other_links_off(const YamlNode& off) {
  YamlNode map;
  map.kind = YamlNode::Kind::map;
  map.mark = off.mark;
  map.entries.push_back({std::string(kOtherLinks), off.mark, false, off});
  return map;
}

const KeyTable* table_below(std::string_view key) {
  if (key == "start") return &kVariedStartKeys;
  if (key == "control_model") return &kVariedModelKeys;
  if (key == "actuators") return &kVariedActuatorsKeys;
  return nullptr;
}

// `table`: of the keys of both maps; nullptr if they are names, or those of one distribution.
void prepare(YamlNode& base, const YamlNode& own, const KeyTable* table) {
  if (is_off(base) && own.is_map() && table != nullptr) base = each_off(base, *table);
  if (!base.is_map() || !own.is_map()) return;
  for (const YamlEntry& entry : own.entries) {
    YamlNode* const below = find(base, entry.key);
    if (below == nullptr) continue;
    if (is_off(entry.value)) {
      erase(base, entry.key);
    } else if (table == &kVariedModelKeys && entry.key == "com" && is_off(*below)) {
      *below = other_links_off(*below);
    } else {
      prepare(*below, entry.value, table == &kVariationKeys ? table_below(entry.key) : nullptr);
    }
  }
  for (const core::KeySpec& kind : kSpreadKeys.keys) {
    if (own.find(kind.name) == nullptr) continue;
    for (const core::KeySpec& other : kSpreadKeys.keys) {
      if (other.name != kind.name) erase(base, other.name);
    }
  }
}

}  // namespace

void prepare_variation(YamlNode& base, const YamlNode& own) {
  if (!base.is_map() || !own.is_map()) return;
  YamlNode* const drawn = find(base, "variation");
  if (drawn == nullptr) return;
  const YamlNode* const ground = own.find("ground");
  const YamlNode* const friction = ground == nullptr ? nullptr : ground->find("friction");
  if (friction != nullptr && !is_off(*friction)) erase(*drawn, "friction");
  const YamlNode* const variation = own.find("variation");
  if (variation == nullptr) return;
  if (is_off(*variation)) {
    erase(base, "variation");
  } else {
    prepare(*drawn, *variation, &kVariationKeys);
  }
}

}  // namespace footfall::model
