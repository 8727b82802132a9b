// Task types, and the signals that a behavior's tasks add.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/load/control/axes.h"
#include "behaviors/load/control/steps.h"

namespace footfall::behaviors {
namespace {

// Adds a task's name and axes; the same name elsewhere adds the axes that are new.
void add_task(LoadContext& context, const core::YamlEntry& entry) {
  const core::YamlNode* type_node = entry.value.find("type");
  if (type_node == nullptr) return;  // reported, as an unknown type is, where it is compiled
  const auto type = tasks::find_task_type(type_node->scalar);
  if (!type) return;
  const tasks::TaskTypeInfo& info = tasks::info(*type);
  core::Diagnostics silent;
  const core::YamlNode* axes = entry.value.find(info.of_joints() ? "joints" : "axes");
  const std::vector<std::string> names = tasks::axis_names(*type, context.behavior.robot);
  auto& known = context.behavior.task_names;
  auto task = std::find_if(known.begin(), known.end(),
                           [&](const TaskName& other) { return other.name == entry.key; });
  if (task == known.end()) {
    known.push_back({entry.key, {}, {}, info.is_rate});
    context.task_type_of_name.push_back(*type);
    task = known.end() - 1;
  }
  const auto k = static_cast<std::size_t>(task - known.begin());
  if (context.task_type_of_name[k] != *type) {
    context.error(type_node->mark, "task-type",
                  fmt::format("task '{}' is a {} elsewhere: its signals would share a name",
                              entry.key, tasks::info(context.task_type_of_name[k]).name));
    return;
  }
  for (const int axis : read_axes(context, *type, axes, silent)) {
    const std::string& name = names[static_cast<std::size_t>(axis)];
    if (std::find(task->axes.begin(), task->axes.end(), name) == task->axes.end()) {
      task->axes.push_back(name);
      task->dimensions.push_back(info.dimension(axis));
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
                       context.behavior.internal_instances, planners, context.behavior.signals,
                       context.behavior.estimator.type != EstimatorType::true_state);
}

}  // namespace footfall::behaviors
