// `base: OTHER.yaml`: one file on top of another; see yaml.h.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/yaml.h"

namespace footfall::core {

namespace {

namespace fs = std::filesystem;

YamlEntry* find_entry(YamlNode& map, std::string_view key) {
  const auto found = std::find_if(map.entries.begin(), map.entries.end(),
                                  [key](const YamlEntry& entry) { return entry.key == key; });
  return found == map.entries.end() ? nullptr : &*found;
}

bool removes(const YamlNode& node) {
  return node.is_scalar() && !node.quoted && node.scalar == "off";
}

// Where the history is written, and the path of the map that is being merged.
struct Recorder {
  YamlHistory* history = nullptr;
  std::string path{};

  Recorder inside(const std::string& key) const {
    return {history, path.empty() ? key : path + "." + key};
  }
  void add(YamlChange::Kind kind, const std::string& key, const YamlNode& old, Mark mark) const {
    if (history != nullptr) history->push_back({kind, inside(key).path, old, mark});
  }
};

// `KEY+: [...]`: puts the items behind those of the base's list KEY.
void append(YamlNode& base, YamlEntry&& own, const Recorder& recorder, Diagnostics& diagnostics) {
  const std::string key = own.key.substr(0, own.key.size() - 1);
  YamlEntry* const target = find_entry(base, key);
  if (target == nullptr || !target->value.is_sequence()) {
    diagnostics.error(own.key_mark, "append", fmt::format("the base has no list '{}'", key));
  } else if (!own.value.is_sequence()) {
    diagnostics.error(own.value.mark, "append",
                      fmt::format("expected a list to append to '{}'", key));
  } else {
    recorder.add(YamlChange::Kind::appended, key, target->value, own.value.mark);
    for (YamlNode& item : own.value.items) target->value.items.push_back(std::move(item));
  }
}

// Puts `own` over `base`: maps by key, all else whole.
void merge(YamlNode& base, YamlNode&& own, const Recorder& recorder, Diagnostics& diagnostics) {
  base.mark = own.mark;
  for (YamlEntry& entry : own.entries) {
    if (entry.key.size() > 1 && entry.key.back() == '+' && !entry.key_quoted) {
      append(base, std::move(entry), recorder, diagnostics);
      continue;
    }
    YamlEntry* const old = find_entry(base, entry.key);
    if (old == nullptr) {
      base.entries.push_back(std::move(entry));
    } else if (removes(entry.value)) {
      recorder.add(YamlChange::Kind::removed, entry.key, old->value, entry.value.mark);
      base.entries.erase(base.entries.begin() + (old - base.entries.data()));
    } else if (old->value.is_map() && entry.value.is_map()) {
      old->key_mark = entry.key_mark;
      merge(old->value, std::move(entry.value), recorder.inside(entry.key), diagnostics);
    } else {
      recorder.add(YamlChange::Kind::replaced, entry.key, old->value, entry.value.mark);
      *old = std::move(entry);
    }
  }
}

// The base's path as the user would write it from here.
std::string path_beside(const std::string& path, const std::string& other) {
  return (fs::path(path).parent_path() / other).lexically_normal().string();
}

std::string identity(const std::string& path) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(path, error);
  return error ? path : canonical.string();
}

YamlNode load_chain(const std::string& path, std::vector<std::string>& chain, YamlHistory* history,
                    Diagnostics& diagnostics);

// Replaces a tree that names a base by the base with the tree over it.
YamlNode resolve(YamlNode root, const std::string& path, std::vector<std::string>& chain,
                 YamlHistory* history, Diagnostics& diagnostics) {
  const YamlNode* const base_node = root.find("base");
  if (base_node == nullptr) return root;
  const Mark place = base_node->mark;
  if (!base_node->is_scalar() || base_node->scalar.empty()) {
    diagnostics.error(place, "base", "expected the path of a YAML file after 'base:'");
    return {};
  }
  const std::string base_path = path_beside(path, base_node->scalar);
  const std::string base_identity = identity(base_path);
  if (std::find(chain.begin(), chain.end(), base_identity) != chain.end()) {
    diagnostics.error(place, "base-cycle",
                      fmt::format("'{}' is its own base in the end", base_path));
    return {};
  }
  std::error_code error;
  if (!fs::is_regular_file(base_path, error)) {  // a pipe would be waited for
    diagnostics.error(place, "base", fmt::format("no file '{}'", base_path));
    return {};
  }
  YamlNode base = load_chain(base_path, chain, history, diagnostics);
  if (base.is_null()) return {};
  // The first key is the kind of file; one that begins with `base:` takes the kind from there.
  const std::string& first = root.entries.front().key;
  if (!base.is_map() || (first != "base" && first != base.entries.front().key)) {
    diagnostics.error(place, "base",
                      fmt::format("'{}' is a file of another kind than '{}'", base_path, first));
    return {};
  }
  std::erase_if(root.entries, [](const YamlEntry& entry) { return entry.key == "base"; });
  merge(base, std::move(root), Recorder{history}, diagnostics);
  return base;
}

YamlNode load_chain(const std::string& path, std::vector<std::string>& chain, YamlHistory* history,
                    Diagnostics& diagnostics) {
  const int errors_before = diagnostics.error_count();
  chain.push_back(identity(path));
  YamlNode root = resolve(load_yaml_file(path, diagnostics), path, chain, history, diagnostics);
  chain.pop_back();
  return diagnostics.error_count() == errors_before ? std::move(root) : YamlNode{};
}

}  // namespace

YamlNode load_yaml_with_base(const std::string& path, Diagnostics& diagnostics,
                             YamlHistory* history) {
  std::vector<std::string> chain;
  return load_chain(path, chain, history, diagnostics);
}

YamlNode load_yaml_text_with_base(std::string_view text, const std::string& name,
                                  Diagnostics& diagnostics) {
  const int errors_before = diagnostics.error_count();
  std::vector<std::string> chain = {identity(name)};
  YamlNode root =
      resolve(load_yaml_text(text, name, diagnostics), name, chain, nullptr, diagnostics);
  return diagnostics.error_count() == errors_before ? std::move(root) : YamlNode{};
}

}  // namespace footfall::core
