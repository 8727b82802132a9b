// Loads a behavior's file with its bases as a tree; see context.h.
#include <fmt/format.h>

#include "behaviors/load/context.h"
#include "behaviors/load/options.h"
#include "behaviors/load/steps.h"
#include "core/text/search_folders.h"
#include "core/yaml/layers.h"

namespace footfall::behaviors {
namespace {

// `lift_time: 160 ms` over a base's {value, range, live} replaces the whole map, because it is not
// a map.
void warn_lost_keys(const core::YamlHistory& history, core::Diagnostics& diagnostics) {
  constexpr std::string_view kSection = "parameters.";
  for (const core::YamlChange& change : history) {
    if (change.kind != core::YamlChange::Kind::replaced || !change.path.starts_with(kSection) ||
        !change.old.is_map()) {
      continue;
    }
    const std::string name = change.path.substr(kSection.size());
    const core::YamlNode* live = change.old.find("live");
    const bool was_live = live != nullptr && live->is_scalar() && live->scalar == "true";
    if (!was_live && change.old.find("range") == nullptr) continue;
    diagnostics.warning(
        change.mark, "lost-keys",
        fmt::format("this replaces the base's '{0}' whole: it has no range any more{1}; "
                    "write {0}: {{value: ...}} to keep the rest",
                    name, was_live ? " and is not live" : ""));
  }
}

}  // namespace

std::vector<std::string> library_folders(const std::vector<std::string>& search) {
  std::vector<std::string> folders;
  for (const std::string& folder : search) folders.push_back(folder + "/behaviors/library");
  return folders;
}

core::YamlNode load_tree(const std::string& path, const LoadOptions& options,
                         core::Diagnostics& diagnostics, core::YamlLayers* layers) {
  core::YamlHistory history;
  core::YamlNode root =
      core::load_yaml_with_base(path, diagnostics, &history,
                                library_folders(core::search_from(path, options.search)), layers);
  warn_lost_keys(history, diagnostics);
  core::warn_lost_items(history, diagnostics);
  return root;
}

core::YamlNode load_tree_text(std::string_view text, const std::string& name,
                              const LoadOptions& options, core::Diagnostics& diagnostics,
                              core::YamlLayers* layers) {
  core::YamlHistory history;
  core::YamlNode root = core::load_yaml_text_with_base(text, name, diagnostics, &history,
                                                       library_folders(options.search), layers);
  warn_lost_keys(history, diagnostics);
  core::warn_lost_items(history, diagnostics);
  return root;
}

}  // namespace footfall::behaviors
