// The task types of the language and their axes. Load time only.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/load/context.h"
#include "tasks/active_set.h"

namespace footfall::behaviors {

struct TaskTypeInfo {
  std::string_view name;
  tasks::TaskType type;
  bool joints = false;              // its axes are the robot's joints
  bool pointed = false;             // has a `point`
  std::vector<std::string> axes;    // in the order of AxisCommand::axis; empty for joints
  std::vector<std::string> frames;  // allowed frames, the default one first
  // Dimension of an axis' measured position, and of its command.
  core::Dimension position(int axis) const;
  core::Dimension acceleration(int axis) const;
};

// nullptr if unknown.
const TaskTypeInfo* find_task_type(std::string_view name);
const TaskTypeInfo& task_type_info(tasks::TaskType type);
// Same, with an error at the node.
const TaskTypeInfo* require_task_type(const core::YamlNode& node, core::Diagnostics& diagnostics);
// Names of all axes of a type on this robot.
std::vector<std::string> all_axes(const LoadContext& context, const TaskTypeInfo& type);
// Indices of the axes in a task's `axes` (or `joints`), in its order; all axes without either.
std::vector<int> read_axes(const LoadContext& context, const TaskTypeInfo& type,
                           const core::YamlNode* axes, core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
