// `base: OTHER.yaml`: merges a file over its base; see yaml.h.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/yaml.h"

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

// Destination of the history, and the path of the map that is being merged.
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

// `KEY+: [...]`: appends the items to the base's list KEY.
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

// Merges `own` over `base`: maps key by key, everything else as a whole.
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

// The path of a base relative to the file that names it, for messages.
std::string path_beside(const std::string& path, const std::string& other) {
  return (fs::path(path).parent_path() / other).lexically_normal().string();
}

std::string identity(const std::string& path) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(path, error);
  return error ? path : canonical.string();
}

// A file and its bases while they are loaded.
struct Chain {
  std::vector<std::string> files{};  // from the outermost file to the one being read
  YamlHistory* history = nullptr;
  const std::vector<std::string>& library;
  Diagnostics& diagnostics;
  const std::vector<FileChange>* changes = nullptr;  // unsaved new contents of files
};

YamlNode load_file(const std::string& path, const Chain& chain) {
  if (chain.changes != nullptr) {
    for (const FileChange& change : *chain.changes) {
      if (identity(change.path) == identity(path)) {
        return load_yaml_text(change.after, path, chain.diagnostics);
      }
    }
  }
  return load_yaml_file(path, chain.diagnostics);
}

// Resolves `base: NAME` to a path; empty and an error if not found.
std::string find_base(const std::string& path, const YamlNode& base, Chain& chain) {
  const std::string& name = base.scalar;
  const std::string beside = path_beside(path, name);
  std::error_code error;
  if (fs::is_regular_file(beside, error)) return beside;  // reading a pipe would block
  std::string problem = fmt::format("no file '{}'", beside);
  if (name.find('/') == std::string::npos && !chain.library.empty()) {
    std::vector<std::string> known;
    for (const std::string& folder : chain.library) {
      for (const char* ending : {"", ".yaml"}) {
        const fs::path candidate = fs::path(folder) / (name + ending);
        if (fs::is_regular_file(candidate, error)) return candidate.lexically_normal().string();
      }
      for (fs::directory_iterator file(folder, error), end; !error && file != end;
           file.increment(error)) {
        if (file->path().extension() == ".yaml") known.push_back(file->path().stem().string());
      }
    }
    problem += fmt::format(
        ", and no '{}.yaml' in a behaviors/library here, above, or in the search path{}", name,
        did_you_mean(name, known));
  }
  chain.diagnostics.error(base.mark, "base", problem);
  return {};
}

YamlNode load_chain(const std::string& path, Chain& chain);

// Replaces a tree that names a base by the base with the tree merged over it.
YamlNode resolve(YamlNode root, const std::string& path, Chain& chain) {
  const YamlNode* const base_node = root.find("base");
  if (base_node == nullptr) return root;
  const Mark place = base_node->mark;
  if (!base_node->is_scalar() || base_node->scalar.empty()) {
    chain.diagnostics.error(place, "base", "expected the path of a YAML file after 'base:'");
    return {};
  }
  const std::string base_path = find_base(path, *base_node, chain);
  if (base_path.empty()) return {};
  if (std::find(chain.files.begin(), chain.files.end(), identity(base_path)) != chain.files.end()) {
    chain.diagnostics.error(place, "base-cycle",
                            fmt::format("'{}' is its own base in the end", base_path));
    return {};
  }
  YamlNode base = load_chain(base_path, chain);
  if (base.is_null()) return {};
  // The first key is the kind of file; a file that begins with `base:` inherits its kind.
  const std::string& first = root.entries.front().key;
  if (!base.is_map() || (first != "base" && first != base.entries.front().key)) {
    chain.diagnostics.error(
        place, "base", fmt::format("'{}' is a file of another kind than '{}'", base_path, first));
    return {};
  }
  std::erase_if(root.entries, [](const YamlEntry& entry) { return entry.key == "base"; });
  merge(base, std::move(root), Recorder{chain.history}, chain.diagnostics);
  return base;
}

YamlNode load_chain(const std::string& path, Chain& chain) {
  const int errors_before = chain.diagnostics.error_count();
  chain.files.push_back(identity(path));
  YamlNode root = resolve(load_file(path, chain), path, chain);
  chain.files.pop_back();
  return chain.diagnostics.error_count() == errors_before ? std::move(root) : YamlNode{};
}

}  // namespace

YamlNode load_yaml_with_base(const std::string& path, Diagnostics& diagnostics,
                             YamlHistory* history, const std::vector<std::string>& library) {
  Chain chain{{}, history, library, diagnostics};
  return load_chain(path, chain);
}

YamlNode load_changed_yaml_with_base(const std::string& path,
                                     const std::vector<FileChange>& changes,
                                     Diagnostics& diagnostics,
                                     const std::vector<std::string>& library) {
  Chain chain{{}, nullptr, library, diagnostics, &changes};
  return load_chain(path, chain);
}

YamlNode load_yaml_text_with_base(std::string_view text, const std::string& name,
                                  Diagnostics& diagnostics, YamlHistory* history,
                                  const std::vector<std::string>& library) {
  const int errors_before = diagnostics.error_count();
  Chain chain{{identity(name)}, history, library, diagnostics};
  YamlNode root = resolve(load_yaml_text(text, name, diagnostics), name, chain);
  return diagnostics.error_count() == errors_before ? std::move(root) : YamlNode{};
}

}  // namespace footfall::core
