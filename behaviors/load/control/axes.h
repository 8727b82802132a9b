// The type and axes of a task, and values by axis: one number for all, a list, a map by axis
// (joints: with globs), a vector parameter or a vector of signals. Load time only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "behaviors/load/context.h"

namespace footfall::behaviors {

// The task type that a node names; nothing and an error at the node if there is no such type.
std::optional<tasks::TaskType> require_task_type(const core::YamlNode& node,
                                                 core::Diagnostics& diagnostics);
// Indices of the axes that a task's `axes` (or `joints`) names, in its order; all without either.
std::vector<int> read_axes(const LoadContext& context, tasks::TaskType type,
                           const core::YamlNode* axes, core::Diagnostics& diagnostics);

// Where the values of a task's axes are written, and what they are.
struct AxesScope {
  const std::vector<std::string>& names;
  const std::vector<core::Dimension>& positions;  // of the task's axes and of `entry`
  std::vector<core::Dimension> dimensions;        // dimensions of the values
  int owner = 0;                                  // state whose clock is `t`
  bool joints = false;
  bool entry = false;  // `entry` is allowed
};

// The positions' dimensions times `factor`.
std::vector<core::Dimension> scaled(const std::vector<core::Dimension>& positions,
                                    core::Dimension factor);

// One expression an axis; -1 for an omitted axis, allowed only with `partial`, or after an error.
std::vector<int> compile_axes(LoadContext& context, const core::YamlNode& node,
                              const AxesScope& axes, bool partial);

}  // namespace footfall::behaviors
