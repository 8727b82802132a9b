// Origin of a value of a file; see explain.h.
#include "core/yaml/explain.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/diagnostics/did_you_mean.h"

namespace footfall::core {
namespace {

// The schema at a path of a file: the table of the map, or the value type of its names.
struct Expected {
  const KeyTable* table = nullptr;
  const ValueSpec* named = nullptr;  // value type of a map with user-defined names
};

Expected behind(const KeySpec& key) {
  for (const ValueSpec& value : key.values) {
    if (value.named && value.kind != ValueKind::none) return {nullptr, &value};
    if (value.map != nullptr) return {value.map, nullptr};
  }
  return {};
}

Expected below_name(const ValueSpec& value) { return {value.map, nullptr}; }

// Length of the longest key of `map` that `path` begins with, 0 if there is none.
std::size_t key_length(const YamlNode& map, std::string_view path) {
  std::size_t longest = 0;
  for (const YamlEntry& entry : map.entries) {
    const bool whole = path.size() == entry.key.size() ||
                       (path.size() > entry.key.size() && path[entry.key.size()] == '.');
    if (path.starts_with(entry.key) && whole) longest = std::max(longest, entry.key.size());
  }
  return longest;
}

bool is_at_or_in(std::string_view path, std::string_view outer) {
  return path == outer ||
         (path.starts_with(outer) && path.size() > outer.size() && path[outer.size()] == '.');
}

std::vector<YamlChange> changes_of(const YamlHistory& history, const std::string& path) {
  std::vector<YamlChange> found;
  for (auto change = history.rbegin(); change != history.rend(); ++change) {
    if (!is_at_or_in(path, change->path)) continue;
    YamlChange own = *change;
    // Old value, looked up inside the map that was replaced.
    std::string_view rest = std::string_view(path).substr(change->path.size());
    const YamlNode* node = &change->old;
    while (node != nullptr && !rest.empty()) {
      rest.remove_prefix(1);
      const std::size_t length = key_length(*node, rest);
      node = length == 0 ? nullptr : node->find(rest.substr(0, length));
      rest.remove_prefix(std::min(length, rest.size()));
    }
    if (node == nullptr) continue;
    const YamlNode old = *node;
    own.old = old;
    found.push_back(std::move(own));
  }
  return found;
}

void add_values(const YamlNode& node, const std::string& path, const YamlHistory& history,
                std::vector<ValueOrigin>& values) {
  if (node.is_map() && !node.entries.empty()) {
    for (const YamlEntry& entry : node.entries) {
      add_values(entry.value, path.empty() ? entry.key : path + "." + entry.key, history, values);
    }
    return;
  }
  values.push_back({path, true, node, changes_of(history, path)});
}

// Adds values that the map had before and that were removed.
void add_removed(const std::string& path, const YamlHistory& history,
                 std::vector<ValueOrigin>& values) {
  for (const YamlChange& change : history) {
    if (change.kind != YamlChange::Kind::removed || !is_at_or_in(change.path, path)) continue;
    const bool known = std::ranges::any_of(
        values, [&](const ValueOrigin& value) { return is_at_or_in(value.path, change.path); });
    if (!known) values.push_back({change.path, false, {}, changes_of(history, change.path)});
  }
}

std::vector<std::string> names_at(const YamlNode& node, const KeyTable* table) {
  std::vector<std::string> names =
      table == nullptr ? std::vector<std::string>() : key_names(*table);
  for (const YamlEntry& entry : node.entries) names.push_back(entry.key);
  return names;
}

}  // namespace

Explanation explain(const YamlNode& root, const YamlHistory& history, const KeyTable* table,
                    std::string_view path) {
  Explanation out;
  const YamlNode* node = &root;
  Expected expected{table, nullptr};
  std::string_view rest = path;
  while (!rest.empty()) {
    std::size_t length = key_length(*node, rest);
    const bool there = length > 0;
    if (!there) length = std::min(rest.find('.'), rest.size());
    const std::string_view key = rest.substr(0, length);
    const bool last = length == rest.size();
    rest.remove_prefix(std::min(length + 1, rest.size()));
    const KeySpec* spec = expected.table == nullptr ? nullptr : find_key(*expected.table, key);
    out.key = spec;
    if (there) {
      node = node->find(key);
      const ValueSpec* others = expected.table == nullptr ? nullptr : expected.table->others;
      const ValueSpec* named = expected.named != nullptr ? expected.named
                               : spec == nullptr         ? others
                                                         : nullptr;
      expected = named != nullptr  ? below_name(*named)
                 : spec != nullptr ? behind(*spec)
                                   : Expected{};
      continue;
    }
    const std::string whole(path);
    add_removed(whole, history, out.values);
    if (!out.values.empty() || (spec != nullptr && last)) return out;
    out.problem =
        fmt::format("unknown key '{}'{}", key, did_you_mean(key, names_at(*node, expected.table)));
    return out;
  }
  add_values(*node, std::string(path), history, out.values);
  add_removed(std::string(path), history, out.values);
  return out;
}

void add_differences(const YamlNode& before, const YamlNode& after, YamlHistory& history) {
  struct Walk {
    YamlHistory& history;
    void maps(const YamlNode& old, const YamlNode& now, const std::string& path) {
      for (const YamlEntry& entry : old.entries) {
        const std::string own = path.empty() ? entry.key : path + "." + entry.key;
        const YamlNode* value = now.find(entry.key);
        if (value == nullptr) continue;
        if (entry.value.is_map() && value->is_map()) {
          maps(entry.value, *value, own);
        } else if (value->mark.file != entry.value.mark.file) {
          history.push_back({YamlChange::Kind::replaced, own, entry.value, value->mark});
        }
      }
    }
  };
  Walk{history}.maps(before, after, "");
}

}  // namespace footfall::core
