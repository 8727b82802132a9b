// Effective values of a behavior file after --set, and of states created by templates. Load time
// only.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "behaviors/loader.h"
#include "core/yaml/explain.h"

namespace footfall::behaviors {

// Edits the tree like `--set NAME=VALUE`; problems are added to `diagnostics`.
void apply_settings(core::YamlNode& root,
                    const std::vector<std::pair<std::string, std::string>>& settings,
                    core::Diagnostics& diagnostics);

// A value of a state after expansion of templates and mirror images.
struct StateExplanation {
  core::Explanation explanation;
  std::vector<std::string> made_from;  // `stride(stance: right_foot)`, outer first
};

// Explains a key such as `machine.states.step.right_foot.lift.after`; `states` may be omitted.
// Compiles the tree: its errors are added to `diagnostics`, and the explanation then has a problem.
StateExplanation explain_state(core::YamlNode root, const std::string& path,
                               const LoadOptions& options, std::string_view key,
                               core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
