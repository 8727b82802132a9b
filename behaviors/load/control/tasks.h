// Compiles tasks, references and internal forces of the merged control. Load time only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "behaviors/load/context.h"
#include "behaviors/load/control/axes.h"
#include "behaviors/load/control/overlay.h"

namespace footfall::behaviors {

// Compiles a task; nullopt after errors.
std::optional<TaskSpec> compile_task(LoadContext& context, const DraftItem& item,
                                     const Draft& draft);
// Compiles the reference into `spec` and its axes (reference.cc, trajectory.cc).
void compile_reference(LoadContext& context, const DraftItem& item, AxesScope axes, TaskSpec& spec,
                       std::vector<AxisSpec>& out);
void compile_trajectory(LoadContext& context, const core::YamlNode& map, const AxesScope& axes,
                        TaskSpec& spec, std::vector<AxisSpec>& out);
// Sets the value and the position of each axis.
void set_values(const core::YamlNode& node, const std::vector<int>& values,
                std::vector<AxisSpec>& out);
// A non-negative scalar of a task or internal force; -1 if the key is absent.
int compile_limit(LoadContext& context, const DraftItem& item, const char* name,
                  core::Dimension dimension);
// Compiles an internal force into one spec a pair of contacts, `between: all` into all pairs of
// `contacts`; nothing after an error (internal.cc).
std::vector<InternalSpec> compile_internals(LoadContext& context, const Draft& draft,
                                            const std::vector<int>& contacts);
// Errors for internal forces that are active in no state.
void report_idle_internals(LoadContext& context);

}  // namespace footfall::behaviors
