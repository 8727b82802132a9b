// References that move without a velocity of their own; see parts.h.
//
// A trajectory gives position, velocity and acceleration; an expression gives a position, and its
// velocity and acceleration count as 0. An axis that follows it at speed v lags by kd/kp v, and by
// a/kp of its acceleration (u = kp e - kd v = a).
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "behaviors/check/physics/parts.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

// The first input of an expression that changes continuously; empty if none does. Planners answer
// now and then, and the places of feet that hold do not move.
std::string moving_input(const Behavior& behavior, const ControlSpec& control, int expression) {
  const Expression& e = behavior.expressions[expression];
  for (int i = e.first; i < e.first + e.count; ++i) {
    const Instruction& step = behavior.expressions.code[at(i)];
    if (step.op == Op::time) return "time";
    if (step.op == Op::state_time) return "t";
    if (step.op != Op::signal) continue;
    const std::string& name = behavior.signals.info(step.index).name;
    const auto holds = [&](int contact) {
      const std::string& foot = behavior.robot.contacts[at(contact)].name;
      return name.starts_with("point." + foot + ".");
    };
    const bool steps = name.starts_with("planner.") || name.starts_with("contact.");
    if (!steps && std::ranges::none_of(control.contacts, holds)) return name;
  }
  return {};
}

void judge(PhysicsContext& context, const ControlSpec& control, const TaskSpec& task,
           const AxisSpec& axis) {
  const Behavior& b = context.behavior;
  if (axis.value < 0) return;
  const std::string input = moving_input(b, control, axis.value);
  if (input.empty()) return;
  std::string lag = "the axis lags";
  if (axis.kp >= 0 && axis.kd >= 0 && b.values[at(axis.kp)] > 0.0) {
    const double time = b.values[at(axis.kd)] / b.values[at(axis.kp)];
    if (time > 0.0)
      lag = fmt::format("the axis lags by kd/kp = {:.3g} ms of its speed", 1e3 * time);
  }
  context.findings.add(
      core::Severity::warning, axis.value_mark, "no-feed-forward", "",
      fmt::format("the reference of task '{}' moves with '{}', and its velocity and acceleration "
                  "count as 0: {}; a `trajectory` has them",
                  b.task_instances[at(task.instance)].name, input, lag));
}

}  // namespace

void check_feed_forward(PhysicsContext& context) {
  const Behavior& b = context.behavior;
  for (const ControlSpec& control : b.controls) {
    for (int k = control.tasks.first; k < control.tasks.end(); ++k) {
      const TaskSpec& task = b.tasks[at(k)];
      if (task.reference.kind != ReferenceSpec::Kind::value) continue;
      for (int a = task.axes.first; a < task.axes.end(); ++a) {
        judge(context, control, task, b.axes[at(a)]);
      }
    }
  }
  context.findings.settle(1);
}

}  // namespace footfall::behaviors
