// Merges the files of a `base:` chain; see layers.h.
#include "core/yaml/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/yaml/edits.h"

namespace footfall::core {

namespace {

YamlEntry* find_entry(YamlNode& map, std::string_view key) {
  const auto found = std::find_if(map.entries.begin(), map.entries.end(),
                                  [key](const YamlEntry& entry) { return entry.key == key; });
  return found == map.entries.end() ? nullptr : &*found;
}

bool removes(const YamlNode& node) {
  return node.is_scalar() && !node.quoted && node.scalar == "off";
}

// Whether the map also has `KEY: off`: then `KEY+:` begins a new list, and means to.
bool removes_key(const YamlNode& own, const std::string& key) {
  const YamlNode* const node = own.find(key);
  return node != nullptr && removes(*node);
}

// Appends the items to the base's list KEY. A state made from a template (`use:`) has that list
// perhaps in its template: then it is kept for there.
void append(YamlNode& base, YamlEntry&& own, bool begins, const MergeRecorder& recorder,
            Diagnostics& diagnostics) {
  const std::string key = own.key.substr(0, own.key.size() - 1);
  YamlEntry* target = find_entry(base, key);
  if (target == nullptr && begins && own.value.is_sequence()) {
    own.key = key;
    base.entries.push_back(std::move(own));
    return;
  }
  if (target == nullptr && base.find("use") != nullptr) {
    target = find_entry(base, own.key);
    if (target == nullptr) {
      base.entries.push_back(std::move(own));
      return;
    }
  }
  if (target == nullptr || !target->value.is_sequence()) {
    diagnostics.error(own.key_mark, "append", fmt::format("the base has no list '{}'", key));
  } else if (!own.value.is_sequence()) {
    diagnostics.error(own.value.mark, "append",
                      fmt::format("expected a list to append to '{}'", key));
  } else {
    recorder.add(YamlChange::Kind::appended, key, target->value, own.value.mark, {});
    for (YamlNode& item : own.value.items) target->value.items.push_back(std::move(item));
  }
}

bool same_content(const YamlNode& a, const YamlNode& b) {
  const auto same_entry = [](const YamlEntry& x, const YamlEntry& y) {
    return x.key == y.key && same_content(x.value, y.value);
  };
  return a.kind == b.kind && a.scalar == b.scalar &&
         std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), same_content) &&
         std::equal(a.entries.begin(), a.entries.end(), b.entries.begin(), b.entries.end(),
                    same_entry);
}

bool contains(const YamlNode& list, const YamlNode& item) {
  return std::any_of(list.items.begin(), list.items.end(),
                     [&](const YamlNode& other) { return same_content(other, item); });
}

// The keys that an item loses to one which begins alike (the same planner, the same event).
std::string lost_keys(const YamlNode& old, const YamlNode& now) {
  std::vector<std::string> lost;
  for (std::size_t k = 0; k < std::min(old.items.size(), now.items.size()); ++k) {
    const YamlNode &was = old.items[k], &is = now.items[k];
    if (was.entries.empty() || is.entries.empty()) continue;
    if (was.entries[0].key != is.entries[0].key ||
        !same_content(was.entries[0].value, is.entries[0].value)) {
      continue;
    }
    for (const YamlEntry& entry : was.entries) {
      if (is.find(entry.key) == nullptr) lost.push_back("`" + entry.key + "`");
    }
  }
  return lost.empty() ? "" : fmt::format(", without its {}", fmt::join(lost, ", "));
}

std::string last_key(const std::string& path) { return path.substr(path.rfind('.') + 1); }

}  // namespace

void merge_maps(YamlNode& base, YamlNode&& own, const MergeRecorder& recorder,
                Diagnostics& diagnostics) {
  base.mark = own.mark;
  for (YamlEntry& entry : own.entries) {
    YamlEntry* const old = find_entry(base, entry.key);
    if (old != nullptr && !removes(entry.value) && old->value.is_map() && entry.value.is_map()) {
      old->key_mark = entry.key_mark;
      merge_maps(old->value, std::move(entry.value), recorder.inside(entry.key), diagnostics);
      continue;
    }
    if (recorder.leaves_out(entry, old)) continue;
    if (entry.key.size() > 1 && entry.key.back() == '+' && !entry.key_quoted) {
      const bool begins = removes_key(own, entry.key.substr(0, entry.key.size() - 1));
      append(base, std::move(entry), begins, recorder, diagnostics);
    } else if (old == nullptr) {
      base.entries.push_back(std::move(entry));
    } else if (removes(entry.value)) {
      recorder.add(YamlChange::Kind::removed, entry.key, old->value, entry.value.mark, {});
      base.entries.erase(base.entries.begin() + (old - base.entries.data()));
    } else {
      recorder.add(YamlChange::Kind::replaced, entry.key, old->value, entry.value.mark,
                   entry.value);
      *old = std::move(entry);
    }
  }
}

void merge_over(YamlNode& base, YamlNode&& own, YamlHistory* history, Diagnostics& diagnostics) {
  merge_maps(base, std::move(own), MergeRecorder{history, nullptr, {}}, diagnostics);
}

void warn_lost_items(const std::string& key, const YamlNode& old, const YamlNode& now,
                     std::string_view of, Diagnostics& diagnostics) {
  if (!old.is_sequence() || !now.is_sequence()) return;
  const auto maps = [](const YamlNode& list) {
    return std::any_of(list.items.begin(), list.items.end(),
                       [](const YamlNode& item) { return item.is_map(); });
  };
  if (now.items.empty()) return;  // `[]` says that it means none
  if (!maps(old)) return;         // values: a list of numbers or names is one thing
  const auto lost = std::count_if(old.items.begin(), old.items.end(),
                                  [&](const YamlNode& item) { return !contains(now, item); });
  if (lost == 0) return;
  diagnostics.warning(now.mark, "lost-items",
                      fmt::format("replaces {0} list of {1}{2}; `{3}+:` appends, beside `{3}: off` "
                                  "it replaces",
                                  of, old.items.size(), lost_keys(old, now), key));
}

void warn_lost_items(const YamlHistory& history, Diagnostics& diagnostics) {
  for (const YamlChange& change : history) {
    if (change.kind != YamlChange::Kind::replaced) continue;
    warn_lost_items(last_key(change.path), change.old, change.now, "the base's", diagnostics);
  }
}

}  // namespace footfall::core
