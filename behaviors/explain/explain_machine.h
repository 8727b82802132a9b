// Values of a behavior file after --set, and of states that templates made. Load time only.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "behaviors/loader.h"
#include "core/yaml/explain.h"

namespace footfall::behaviors {

// Edits the tree as `--set NAME=VALUE` does; problems go to `diagnostics`.
void apply_settings(core::YamlNode& root,
                    const std::vector<std::pair<std::string, std::string>>& settings,
                    core::Diagnostics& diagnostics);

// A value of a state as it is when templates and mirror images are expanded.
struct StateExplanation {
  core::Explanation explanation;
  std::vector<std::string> made_from;  // `stride(stance: right_foot)`, outer first
};

// `machine.states.step.right_foot.lift.after`; `states` may be left out. The tree is compiled:
// its errors go to `diagnostics`, and the explanation has a problem then.
StateExplanation explain_state(core::YamlNode root, const std::string& path,
                               const LoadOptions& options, std::string_view key,
                               core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
