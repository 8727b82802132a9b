// Task types, and the signals that a behavior's tasks add.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "behaviors/load/control/steps.h"
#include "behaviors/load/control/task_types.h"
#include "core/yaml/glob.h"

namespace footfall::behaviors {
namespace {

using tasks::TaskType;

const std::vector<TaskTypeInfo>& task_types() {
  const std::vector<std::string> xyz = {"x", "y", "z"};
  const std::vector<std::string> rpy = {"roll", "pitch", "yaw"};
  const std::vector<std::string> places = {"world", "stance"};
  const std::vector<std::string> headings = {"heading", "world"};
  static const std::vector<TaskTypeInfo> types = {
      {"com_position", TaskType::com_position, false, false, xyz, places},
      {"body_orientation", TaskType::body_orientation, false, false, rpy, headings},
      {"point_position", TaskType::point_position, false, true, xyz, places},
      {"frame_orientation", TaskType::frame_orientation, false, true, rpy, headings},
      {"frame_pose",
       TaskType::frame_pose,
       false,
       true,
       {"x", "y", "z", "roll", "pitch", "yaw"},
       places},
      {"joint_posture", TaskType::joint_posture, true, false, {}, {}},
      {"joint_damping", TaskType::joint_damping, true, false, {}, {}},
      {"centroidal_angular_momentum",
       TaskType::centroidal_angular_momentum,
       false,
       false,
       xyz,
       {"world", "heading"}},
  };
  return types;
}

// Adds a task's name and axes; another task of the same name adds its further axes.
void add_task(LoadContext& context, const core::YamlEntry& entry) {
  const core::YamlNode* type_node = entry.value.find("type");
  const TaskTypeInfo* type = type_node == nullptr ? nullptr : find_task_type(type_node->scalar);
  if (type == nullptr) return;  // reported when the task is compiled
  core::Diagnostics silent;
  const core::YamlNode* axes = entry.value.find(type->joints ? "joints" : "axes");
  const std::vector<std::string> names = all_axes(context, *type);
  auto& tasks = context.behavior.task_names;
  auto task = std::find_if(tasks.begin(), tasks.end(),
                           [&](const TaskName& other) { return other.name == entry.key; });
  if (task == tasks.end()) {
    tasks.push_back({entry.key, {}, {}, type->type == TaskType::centroidal_angular_momentum});
    context.task_type_of_name.push_back(type->name);
    task = tasks.end() - 1;
  }
  const auto k = static_cast<std::size_t>(task - tasks.begin());
  if (context.task_type_of_name[k] != type->name) {
    context.error(type_node->mark, "task-type",
                  fmt::format("task '{}' is a {} elsewhere: its signals would share a name",
                              entry.key, context.task_type_of_name[k]));
    return;
  }
  for (const int axis : read_axes(context, *type, axes, silent)) {
    const std::string& name = names[static_cast<std::size_t>(axis)];
    if (std::find(task->axes.begin(), task->axes.end(), name) == task->axes.end()) {
      task->axes.push_back(name);
      task->dimensions.push_back(type->position(axis));
    }
  }
}

void add_all(LoadContext& context, const core::YamlNode& keys) {
  if (const core::YamlNode* tasks = keys.find("tasks")) {
    for (const core::YamlEntry& entry : tasks->entries) add_task(context, entry);
  }
  if (const core::YamlNode* internals = keys.find("internal")) {
    auto& names = context.behavior.internal_instances;
    for (const core::YamlEntry& entry : internals->entries) {
      if (std::find(names.begin(), names.end(), entry.key) == names.end()) {
        names.push_back(entry.key);
      }
    }
  }
}

}  // namespace

core::Dimension TaskTypeInfo::position(int axis) const {
  switch (type) {
    case TaskType::com_position:
    case TaskType::point_position:
      return core::kLength;
    case TaskType::frame_pose:
      return axis < 3 ? core::kLength : core::kNone;
    case TaskType::centroidal_angular_momentum:
      return core::kAngularMomentum;
    case TaskType::body_orientation:
    case TaskType::frame_orientation:
    case TaskType::joint_posture:
    case TaskType::joint_damping:
      break;
  }
  return core::kNone;
}

// Momentum is already a rate: its first derivative is commanded.
core::Dimension TaskTypeInfo::acceleration(int axis) const {
  const bool momentum = type == TaskType::centroidal_angular_momentum;
  return position(axis) / (momentum ? core::kTime : core::kTime * core::kTime);
}

const TaskTypeInfo* find_task_type(std::string_view name) {
  for (const TaskTypeInfo& type : task_types()) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

const TaskTypeInfo& task_type_info(TaskType type) {
  const auto& types = task_types();
  return *std::find_if(types.begin(), types.end(),
                       [type](const TaskTypeInfo& info) { return info.type == type; });
}

const TaskTypeInfo* require_task_type(const core::YamlNode& node, core::Diagnostics& diagnostics) {
  if (!core::expect_scalar(node, "a type of task", diagnostics)) return nullptr;
  if (const TaskTypeInfo* type = find_task_type(node.scalar)) return type;
  std::vector<std::string> names;
  for (const TaskTypeInfo& type : task_types()) names.emplace_back(type.name);
  diagnostics.error(node.mark, "unknown-task-type",
                    fmt::format("unknown task type '{}'{}", node.scalar,
                                core::did_you_mean_or_list(node.scalar, names)));
  return nullptr;
}

std::vector<std::string> all_axes(const LoadContext& context, const TaskTypeInfo& type) {
  return type.joints ? context.joint_names() : type.axes;
}

std::vector<int> read_axes(const LoadContext& context, const TaskTypeInfo& type,
                           const core::YamlNode* axes, core::Diagnostics& diagnostics) {
  const std::vector<std::string> names = all_axes(context, type);
  if (axes == nullptr) {
    std::vector<int> all(names.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  return core::expand_names(*axes, names, type.joints ? "joint" : "axis", diagnostics);
}

void load_signals(LoadContext& context) {
  if (!context.behavior.has_robot) return;
  if (const core::YamlNode* stacks = context.section("stacks")) {
    for (const core::YamlEntry& entry : stacks->entries) add_all(context, entry.value);
  }
  for (const StateSource* source : context.sources) add_all(context, source->keys);
  std::vector<std::string> planners;
  for (const PlannerInfo& planner : context.behavior.planners) planners.push_back(planner.name);
  context.behavior.layout =
      register_signals(context.behavior.robot, context.behavior.task_names,
                       context.behavior.internal_instances, planners, context.behavior.signals);
}

}  // namespace footfall::behaviors
