// Merges a state over its template; see template_merge.h.
#include "behaviors/load/template_merge.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/yaml/layers.h"

namespace footfall::behaviors {
namespace {

bool is_template_key(std::string_view key) {
  return key == "use" || key == "mirror" || key == "with" || key == "args";
}

core::YamlEntry* find_entry(core::YamlNode& map, std::string_view key) {
  const auto found = std::find_if(map.entries.begin(), map.entries.end(),
                                  [&](const auto& entry) { return entry.key == key; });
  return found == map.entries.end() ? nullptr : &*found;
}

// `KEY+: [...]` of an instance: appends to the template's list, or begins one.
void append(LoadContext& context, core::YamlNode& base, const core::YamlEntry& entry) {
  const std::string key = entry.key.substr(0, entry.key.size() - 1);
  if (!core::expect_sequence(entry.value, fmt::format("a list to append to '{}'", key),
                             context.diagnostics)) {
    return;
  }
  core::YamlEntry* const found = find_entry(base, key);
  if (found == nullptr) {
    base.entries.push_back({key, entry.key_mark, entry.key_quoted, entry.value});
  } else if (found->value.is_sequence()) {
    found->value.items.insert(found->value.items.end(), entry.value.items.begin(),
                              entry.value.items.end());
  } else {
    context.error(entry.key_mark, "append", fmt::format("the template has no list '{}'", key));
  }
}

}  // namespace

void merge_over_template(LoadContext& context, core::YamlNode& base, const core::YamlNode& over) {
  for (const core::YamlEntry& entry : over.entries) {
    if (is_template_key(entry.key)) continue;
    if (entry.key.size() > 1 && entry.key.back() == '+' && !entry.key_quoted) {
      append(context, base, entry);
      continue;
    }
    core::YamlEntry* const found = find_entry(base, entry.key);
    if (found == nullptr) {
      if (!core::is_off(entry.value)) base.entries.push_back(entry);
    } else if (core::is_off(entry.value)) {
      base.entries.erase(base.entries.begin() + (found - base.entries.data()));
    } else if (found->value.is_map() && entry.value.is_map()) {
      merge_over_template(context, found->value, entry.value);
    } else {
      core::warn_lost_items(entry.key, found->value, entry.value, "the template's",
                            context.diagnostics);
      found->value = entry.value;
    }
  }
}

}  // namespace footfall::behaviors
