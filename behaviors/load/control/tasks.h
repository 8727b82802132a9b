// Compiling the tasks, references and internal forces of a draft. Load time only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "behaviors/load/context.h"
#include "behaviors/load/control/axes.h"
#include "behaviors/load/control/overlay.h"

namespace footfall::behaviors {

// A task as compiled; nothing and errors if it cannot be.
std::optional<TaskSpec> compile_task(LoadContext& context, const DraftItem& item,
                                     const Draft& draft);
// The reference into `spec` and its axes (reference.cc, trajectory.cc).
void compile_reference(LoadContext& context, const DraftItem& item, AxesScope axes, TaskSpec& spec,
                       std::vector<AxisSpec>& out);
void compile_trajectory(LoadContext& context, const core::YamlNode& map, const AxesScope& axes,
                        TaskSpec& spec, std::vector<AxisSpec>& out);
// The value of each axis and where it is written.
void set_values(const core::YamlNode& node, const std::vector<int>& values,
                std::vector<AxisSpec>& out);
// A scalar of a task or internal force that must not be negative; -1 if the key is not there.
int compile_limit(LoadContext& context, const DraftItem& item, const char* name,
                  core::Dimension dimension);
// An internal force as a pair of contacts each, `between: all` as all pairs of `contacts`; nothing
// after an error (internal.cc).
std::vector<InternalSpec> compile_internals(LoadContext& context, const Draft& draft,
                                            const std::vector<int>& contacts);

}  // namespace footfall::behaviors
