// The files of a `base:` chain one by one: merging them, what a file loses of its base without a
// word, and which of its edits is the cause of an error in the base's text. Load time only.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/yaml/yaml.h"

namespace footfall::core {

// Adapts a base to the file that is merged over it, for keys that merge in their own way.
using PrepareMerge = void (*)(YamlNode& base, const YamlNode& own);

// The files as written, without their `base:` key, the innermost base first.
struct YamlLayers {
  std::vector<YamlNode> files;
  PrepareMerge prepare = nullptr;
};

// Merges `own` over `base`: maps key by key, everything else as a whole, `NAME: off` removes,
// `KEY+:` appends.
void merge_over(YamlNode& base, YamlNode&& own, YamlHistory* history, Diagnostics& diagnostics);

// Warns where a list of maps (actions, transitions, invokes, expectations) replaces one of the base
// and items of that are lost.
void warn_lost_items(const YamlHistory& history, Diagnostics& diagnostics);
// The same for one list; `of` names the owner: "the base's", "the template's".
void warn_lost_items(const std::string& key, const YamlNode& old, const YamlNode& now,
                     std::string_view of, Diagnostics& diagnostics);

// A mistake in an overlay is often found in its base, where the wrong value is used or a removed
// name is missing. `found`: the problems of a load that began with `before`. Errors in a base that
// are gone without one edit of a file on top are replaced by one error at that edit, which also
// says where it was found; with Blamed::all warnings, too. `load` loads a merged tree and reports
// to the diagnostics given.
using TreeLoader = std::function<void(YamlNode, Diagnostics&)>;
enum class Blamed { errors, all };
Diagnostics blame_edits(const YamlLayers& layers, const Diagnostics& before,
                        const Diagnostics& found, const TreeLoader& load,
                        Blamed what = Blamed::errors);

// Loads a file and its bases by `load(root, diagnostics)`, with errors where they were typed.
// `lists`: with the warnings about lost items. `library`: folders of bases that are named.
template <typename Load>
auto load_over_base(const std::string& path, bool lists, Diagnostics& diagnostics, const Load& load,
                    PrepareMerge prepare = nullptr, const std::vector<std::string>& library = {}) {
  YamlHistory history;
  YamlLayers layers{{}, prepare};
  YamlNode root = load_yaml_with_base(path, diagnostics, &history, library, &layers);
  if (lists) warn_lost_items(history, diagnostics);
  Diagnostics found = diagnostics;
  auto result = load(root, found);
  const bool failed = !root.is_null() && found.error_count() > diagnostics.error_count();
  diagnostics =
      failed
          ? blame_edits(layers, diagnostics, found,
                        [&](const YamlNode& tree, Diagnostics& problems) { load(tree, problems); })
          : std::move(found);
  return result;
}

}  // namespace footfall::core
