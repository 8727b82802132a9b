// What a tick writes into the signal table: measured values before the machine, control after it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/index.h"
#include "engine/tick/control_loop.h"

namespace footfall::engine {
namespace {

template <std::size_t N>
void put(core::SignalTable& table, int first, const std::array<double, N>& values) noexcept {
  std::copy(values.begin(), values.end(), table.values() + first);
}

}  // namespace

void ControlLoop::write_measured_signals() noexcept {
  const behaviors::SignalLayout& layout = behavior_.layout;
  const model::State& s = model_.state();
  signals_[layout.time] = time();
  put(signals_, layout.com_pos, model_.com().position);
  put(signals_, layout.com_vel, model_.com().velocity);
  put(signals_, layout.base_pos, s.p_WB);
  put(signals_, layout.base_vel, s.v_WB);
  put(signals_, layout.base_rpy, model_.rpy());
  put(signals_, layout.base_angvel, s.w_WB_B);
  put(signals_, layout.centroidal_momentum, model_.centroidal_momentum());
  for (std::size_t c = 0; c < layout.contact.size(); ++c) {
    signals_[layout.contact[c]] = sensors_.contact[c] ? 1.0 : 0.0;
    put(signals_, layout.force[c], sensors_.force[c]);
  }
  for (std::size_t p = 0; p < layout.point.size(); ++p) {
    put(signals_, layout.point[p], model_.point_position(static_cast<int>(p)));
  }
  for (std::size_t j = 0; j < layout.joint.size(); ++j) {
    signals_[layout.joint[j]] = s.q[j];
    signals_[layout.joint[j] + 1] = s.qd[j];
    signals_[layout.joint[j] + 2] = sensors_.tau[j];
  }
}

void ControlLoop::write_control_signals() noexcept {
  const behaviors::SignalLayout& layout = behavior_.layout;
  const tasks::ActiveControl& control = machine_->control();
  const tasks::ControllerResult& result = controller_.result();
  for (std::size_t c = 0; c < layout.support.size(); ++c) {
    signals_[layout.support[c]] = 0.0;
    put(signals_, layout.force_cmd[c], result.force[c]);
  }
  for (int i = 0; i < control.primary.contact_count; ++i) {
    signals_[layout.support[at(control.primary.contacts[at(i)])]] = 1.0;
  }
  for (std::size_t j = 0; j < layout.joint.size(); ++j) {
    signals_[layout.joint[j] + 3] = commands_.tau[j];
  }
  const auto active = machine_->active_atomic();
  signals_[layout.state] = active.empty() ? -1.0 : active.front();
  signals_[layout.transition_weight] = control.has_other ? control.other_weight : 0.0;
  signals_[layout.torque_step] = safety_.torque_step();
  if (!behavior_.planners.empty() && behavior_.planners.front().goal_slot >= 0) {
    const auto slot = at(behavior_.planners.front().goal_slot);
    signals_[layout.goal] = machine_->parameters()[slot];
    signals_[layout.goal + 1] = machine_->parameters()[slot + 1];
  }
  double faults = 0.0;
  for (const std::int64_t n : faults_.count) faults += static_cast<double>(n);
  signals_[layout.faults] = faults;
  leave_gaps();
  write_internal_signals();
  write_task_signals();
}

// What is not in force has no value: a gap in the log, false in a condition.
void ControlLoop::leave_gaps() noexcept {
  const auto leave = [&](std::vector<unsigned char>& in_force,
                         const std::vector<std::vector<int>>& rows) {
    for (std::size_t k = 0; k < in_force.size(); ++k) {
      if (in_force[k] == 0) continue;
      in_force[k] = 0;
      for (const int row : rows[k]) signals_[row] = std::numeric_limits<double>::quiet_NaN();
    }
  };
  leave(task_in_force_, task_rows_);
  leave(internal_in_force_, internal_rows_);
}

// In the behavior's own convention; of several pairs (`between: all`) the mean.
void ControlLoop::write_internal_signals() noexcept {
  const tasks::ControlSet& set = machine_->control().primary;
  const tasks::ControllerResult& result = controller_.result();
  for (int i = 0; i < set.internal_count; ++i) {
    const tasks::InternalCommand& c = set.internals[at(i)];
    const behaviors::InternalSignals& out = behavior_.layout.internal[at(c.instance)];
    double pairs = 0.0;
    double sum = 0.0;
    for (int j = 0; j < set.internal_count; ++j) {
      if (set.internals[at(j)].instance != c.instance) continue;
      pairs += 1.0;
      sum += result.internal_measured[at(j)];
    }
    signals_[out.reference] = c.reference / c.scale;
    signals_[out.measured] = sum / pairs / c.scale;
    internal_in_force_[at(c.instance)] = 1;
  }
}

void ControlLoop::write_task_signals() noexcept {
  const behaviors::SignalLayout& layout = behavior_.layout;
  const tasks::ControlSet& set = machine_->control().primary;
  const tasks::ControllerResult& result = controller_.result();
  put(signals_, layout.com_ref, model_.com().position);
  for (int t = 0; t < set.task_count; ++t) {
    const tasks::TaskCommand& task = set.tasks[at(t)];
    const behaviors::TaskInstance& instance = behavior_.task_instances[at(task.instance)];
    const behaviors::TaskSignals& out = layout.task[at(instance.signals)];
    const std::vector<int>& columns = axis_column_[at(instance.signals)];
    task_in_force_[at(instance.signals)] = 1;
    double squared = 0.0;
    for (int i = 0; i < task.axis_count; ++i) {
      const tasks::AxisCommand& command = set.axes[at(task.first_axis + i)];
      const tasks::AxisEvaluation& value = result.axes[at(task.first_axis + i)];
      if (task.type == tasks::TaskType::com_position) {
        signals_[layout.com_ref + command.axis] = command.ref;
      }
      const int column = columns[at(command.axis)];
      if (column < 0) continue;
      if (out.in_norm[at(column)]) squared += value.error * value.error;
      signals_[out.axis_error[at(column)]] = value.error;
      signals_[out.axis_reference[at(column)]] = command.ref;
      signals_[out.axis_measured[at(column)]] = value.measured;
      signals_[out.axis_commanded[at(column)]] = value.commanded;
      signals_[out.axis_achieved[at(column)]] = result.achieved[at(task.first_axis + i)];
    }
    signals_[out.error] = std::sqrt(squared);
    signals_[out.rank] = result.tasks[at(t)].rank;
    signals_[out.condition] = result.tasks[at(t)].condition;
    signals_[out.authority] = result.tasks[at(t)].authority;
  }
}

}  // namespace footfall::engine
