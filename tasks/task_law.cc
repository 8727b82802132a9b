// PID laws on a task's rows; see task_law.h.
#include "tasks/task_law.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace footfall::tasks {
TaskMemory::TaskMemory(int instances, int joints)
    : stride_(std::max(6, joints)),
      integral_(at(instances * stride_), 0.0),
      last_tick_(at(instances * stride_), -1) {}

bool TaskMemory::claim(int instance, int axis, std::int64_t tick) noexcept {
  std::int64_t& last = last_tick_[at(instance * stride_ + axis)];
  if (last == tick) return false;
  last = tick;
  return true;
}

void TaskMemory::take_over(const TaskMemory& old, const std::vector<int>& instances) noexcept {
  std::ranges::fill(integral_, 0.0);
  std::ranges::fill(last_tick_, -1);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (instances[i] < 0) continue;
    const std::size_t from = i * at(stride_), to = at(instances[i]) * at(stride_);
    for (std::size_t k = 0; k < at(stride_); ++k) integral_[to + k] = old.integral_[from + k];
  }
}

double measured_position(const model::ControlModel& model, TaskType type, int point,
                         int axis) noexcept {
  return info(type).measured(model, point, axis);
}

double measured_velocity(const model::ControlModel& model, TaskType type, int point,
                         int axis) noexcept {
  const MeasuredFunction velocity = info(type).velocity;
  return velocity == nullptr ? 0.0 : velocity(model, point, axis);
}

void task_rows(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
               double* J, double* J_bias, AxisEvaluation* out) noexcept {
  const Rows rows = {J, J_bias, out, context.model->nv()};
  std::fill_n(J, task.axis_count * rows.n, 0.0);
  std::fill_n(J_bias, task.axis_count, 0.0);
  std::fill_n(out, task.axis_count, AxisEvaluation{});
  info(task.type).rows({*context.model,
                        task.point,
                        task.frame,
                        {axes, extent(task.axis_count)},
                        {context.contacts, extent(context.contact_count)}},
                       rows);
}

void evaluate_task(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
                   double* J, double* J_bias, AxisEvaluation* out) noexcept {
  task_rows(task, axes, context, J, J_bias, out);
  const bool is_rate = info(task.type).is_rate;
  for (int i = 0; i < task.axis_count; ++i) {
    const AxisCommand& a = axes[i];
    double& integral = context.memory->integral(task.instance, a.axis);
    if (context.memory->claim(task.instance, a.axis, context.tick)) {
      if (task.fresh || a.fresh) integral = 0.0;
      // One bad measurement must not stay in the integral for ever.
      if (std::isfinite(out[i].error)) integral += out[i].error * context.period;
      if (a.integral_limit > 0.0) {
        integral = std::clamp(integral, -a.integral_limit, a.integral_limit);
      }
    }
    double u = is_rate ? a.ref_vel + a.kd * out[i].error + a.kp * integral
                       : a.ref_acc + a.kp * out[i].error + a.kd * (a.ref_vel - out[i].velocity) +
                             a.ki * integral;
    if (a.acceleration_limit > 0.0) {
      u = std::clamp(u, -a.acceleration_limit, a.acceleration_limit);
    }
    out[i].commanded = u;
  }
}

}  // namespace footfall::tasks
