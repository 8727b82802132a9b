// Control specs at rest; see control_set.h.
#include "behaviors/compiled/control_set.h"

#include <algorithm>

#include "behaviors/compiled/static_values.h"
#include "core/index.h"

namespace footfall::behaviors {

void fill_control_set(const Behavior& behavior, const ControlSpec& spec, tasks::ControlSet& set) {
  const StaticValues values(behavior);
  set = {};
  set.contact_count = static_cast<int>(spec.contacts.size());
  std::copy(spec.contacts.begin(), spec.contacts.end(), set.contacts.begin());
  for (int k = spec.tasks.first; k < spec.tasks.end(); ++k) {
    const TaskSpec& task = behavior.tasks[at(k)];
    tasks::TaskCommand& command = set.tasks[at(set.task_count++)];
    command.instance = task.instance;
    command.type = task.type;
    command.point = task.point;
    command.frame = task.frame;
    command.priority = task.priority;
    command.first_axis = set.axis_count;
    command.axis_count = task.axes.count;
    for (int a = task.axes.first; a < task.axes.end(); ++a) {
      const AxisSpec& axis = behavior.axes[at(a)];
      tasks::AxisCommand& out = set.axes[at(set.axis_count++)];
      out.axis = axis.axis;
      out.weight = values.of(axis.weight).value_or(out.weight);
    }
  }
  for (int k = spec.internals.first; k < spec.internals.end(); ++k) {
    const InternalSpec& internal = behavior.internals[at(k)];
    tasks::InternalCommand& command = set.internals[at(set.internal_count++)];
    command.instance = internal.instance;
    command.contact_count = internal.contact_count;
    command.contacts = internal.contacts;
    command.statics = values.of(internal.statics).value_or(0.0);
    command.scale = internal.scale;
  }
}

tasks::ControllerSizes controller_sizes(const Behavior& behavior) {
  tasks::ControllerSizes sizes;
  sizes.task_instances = std::max<int>(1, static_cast<int>(behavior.task_instances.size()));
  sizes.contacts = std::max<int>(1, static_cast<int>(behavior.robot.contacts.size()));
  sizes.task_rows = 0;
  for (const TaskInstance& task : behavior.task_instances) {
    sizes.task_rows += tasks::info(task.type).axis_count(behavior.robot.joint_count());
  }
  sizes.task_rows = std::clamp(sizes.task_rows, 1, core::kMaxAxes);
  sizes.levels = std::max(1, sizes.task_instances);
  return sizes;
}

bool law_holds(const Behavior& behavior, int control, int contact) noexcept {
  const auto contains = [contact](const std::vector<int>& list) {
    return std::find(list.begin(), list.end(), contact) != list.end();
  };
  const ControlSpec& spec = behavior.controls[at(control)];
  if (contains(spec.contacts)) return true;
  if (spec.transition < 0) return false;
  const TransitionSpec& transition = behavior.contact_transitions[at(spec.transition)];
  return transition.loads && contains(transition.contacts);
}

}  // namespace footfall::behaviors
