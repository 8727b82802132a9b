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
  bool pointed = false;             // of a `point`
  std::vector<std::string> axes;    // in the order of AxisCommand::axis; empty for joints
  std::vector<std::string> frames;  // that it may be given in, the usual one first
  // Of an axis: what it measures, and what it is told to do.
  core::Dimension position(int axis) const;
  core::Dimension acceleration(int axis) const;
};

// nullptr for a type that is unknown.
const TaskTypeInfo* find_task_type(std::string_view name);
const TaskTypeInfo& task_type_info(tasks::TaskType type);
// The same, with an error at the node.
const TaskTypeInfo* require_task_type(const core::YamlNode& node, core::Diagnostics& diagnostics);
// Names of all axes that a type may have on this robot.
std::vector<std::string> all_axes(const LoadContext& context, const TaskTypeInfo& type);
// Indices of the axes that a task's `axes` (or `joints`) names, in its order; all without either.
std::vector<int> read_axes(const LoadContext& context, const TaskTypeInfo& type,
                           const core::YamlNode* axes, core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
