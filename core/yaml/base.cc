// `base: OTHER.yaml`: merges a file over its base; see yaml.h.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/layers.h"
#include "core/yaml/yaml.h"

namespace footfall::core {

namespace {

namespace fs = std::filesystem;

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
  YamlLayers* layers = nullptr;                      // receives the files, if it is given
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
    const fs::path place = fs::path(chain.library.front()).lexically_normal();
    problem += fmt::format(", and no '{}.yaml' in a {} here, above, or in the search path{}", name,
                           (place.parent_path().filename() / place.filename()).string(),
                           did_you_mean(name, known));
  }
  chain.diagnostics.error(base.mark, "base", problem);
  return {};
}

YamlNode load_chain(const std::string& path, Chain& chain);

// Replaces a tree that names a base by the base with the tree merged over it.
YamlNode resolve(YamlNode root, const std::string& path, Chain& chain) {
  const YamlNode* const base_node = root.find("base");
  if (base_node == nullptr) {
    if (chain.layers != nullptr) chain.layers->files.push_back(root);
    return root;
  }
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
  static const std::vector<std::string> kKinds = {"behavior", "robot", "world", "scenario",
                                                  "sweep"};
  if (first != "base" && std::ranges::find(kKinds, first) == kKinds.end() && base.is_map() &&
      first != base.entries.front().key) {
    chain.diagnostics.error(
        root.entries.front().key_mark, "unknown-key",
        fmt::format("unknown first key '{}'{}", first, did_you_mean_or_list(first, kKinds)));
    return {};
  }
  if (!base.is_map() || (first != "base" && first != base.entries.front().key)) {
    chain.diagnostics.error(
        place, "base", fmt::format("'{}' is a file of another kind than '{}'", base_path, first));
    return {};
  }
  std::erase_if(root.entries, [](const YamlEntry& entry) { return entry.key == "base"; });
  if (chain.layers != nullptr) {
    chain.layers->files.push_back(root);
    if (chain.layers->prepare != nullptr) chain.layers->prepare(base, root);
  }
  merge_over(base, std::move(root), chain.history, chain.diagnostics);
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
                             YamlHistory* history, const std::vector<std::string>& library,
                             YamlLayers* layers) {
  Chain chain{{}, history, library, diagnostics, nullptr, layers};
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
                                  const std::vector<std::string>& library, YamlLayers* layers) {
  const int errors_before = diagnostics.error_count();
  Chain chain{{identity(name)}, history, library, diagnostics, nullptr, layers};
  YamlNode root = resolve(load_yaml_text(text, name, diagnostics), name, chain);
  return diagnostics.error_count() == errors_before ? std::move(root) : YamlNode{};
}

}  // namespace footfall::core
