// Measured values, control and gaps; see signals.h.
#include "engine/tick/signals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "behaviors/compiled/take_over_map.h"
#include "core/index.h"
#include "engine/estimators/truth.h"

namespace footfall::engine {
namespace {

template <std::size_t N>
void put(core::SignalTable& table, int first, const std::array<double, N>& values) noexcept {
  std::copy(values.begin(), values.end(), table.values() + first);
}

// Where the signals of a task's axis are: tasks of one name list only the axes they use, by name.
std::vector<std::vector<int>> axis_columns(const behaviors::Behavior& behavior) {
  std::vector<std::vector<int>> columns(behavior.task_names.size());
  for (const behaviors::TaskInstance& task : behavior.task_instances) {
    const auto index = static_cast<std::size_t>(task.signals);
    const std::vector<std::string>& used = behavior.task_names[index].axes;
    columns[index].clear();
    for (const std::string& name : tasks::axis_names(task.type, behavior.robot)) {
      const auto found = std::find(used.begin(), used.end(), name);
      columns[index].push_back(found == used.end() ? -1 : static_cast<int>(found - used.begin()));
    }
  }
  return columns;
}

// All signals of a task or internal force, by name.
std::vector<std::vector<int>> rows_of(const behaviors::Behavior& behavior, const std::string& kind,
                                      const std::vector<std::string>& names) {
  std::vector<std::vector<int>> rows;
  for (const std::string& name : names) {
    std::vector<int>& own = rows.emplace_back();
    const std::string prefix = kind + "." + name + ".";
    for (int s = 0; s < behavior.signals.size(); ++s) {
      if (behavior.signals.info(s).name.starts_with(prefix)) own.push_back(s);
    }
  }
  return rows;
}

std::vector<std::string> task_names(const behaviors::Behavior& behavior) {
  std::vector<std::string> names;
  for (const behaviors::TaskName& task : behavior.task_names) names.push_back(task.name);
  return names;
}

}  // namespace

SignalWriter::SignalWriter(const behaviors::Behavior& behavior, core::SignalTable& signals)
    : behavior_(behavior),
      signals_(signals),
      axis_column_(axis_columns(behavior)),
      task_rows_(rows_of(behavior, "task", task_names(behavior))),
      internal_rows_(rows_of(behavior, "internal", behavior.internal_instances)),
      task_in_force_(task_rows_.size(), 1),
      internal_in_force_(internal_rows_.size(), 1) {}

void SignalWriter::write_measured(double time, const model::ControlModel& model,
                                  const hal::Sensors& sensors, const Estimate& estimate) noexcept {
  const behaviors::SignalLayout& layout = behavior_.layout;
  const model::State& s = model.state();
  signals_[layout.time] = time;
  put(signals_, layout.com_pos, model.com().position);
  put(signals_, layout.com_vel, model.com().velocity);
  put(signals_, layout.base_pos, s.p_WB);
  put(signals_, layout.base_vel, s.v_WB);
  put(signals_, layout.base_rpy, model.rpy());
  put(signals_, layout.base_angvel, s.w_WB_B);
  put(signals_, layout.centroidal_momentum, model.centroidal_momentum());
  for (std::size_t c = 0; c < layout.contact.size(); ++c) {
    signals_[layout.contact[c]] = estimate.contact[c] ? 1.0 : 0.0;
    put(signals_, layout.force[c], sensors.force[c]);
  }
  put(signals_, layout.aid_force, sensors.aid_force);
  write_quality(estimate.quality);
  write_truth(model, sensors);
  signals_[layout.motor_saturated] = sensors.motor_saturated ? 1.0 : 0.0;
  for (std::size_t p = 0; p < layout.point.size(); ++p) {
    put(signals_, layout.point[p], model.point_position(static_cast<int>(p)));
  }
  for (std::size_t j = 0; j < layout.joint.size(); ++j) {
    signals_[layout.joint[j]] = s.q[j];
    signals_[layout.joint[j] + 1] = s.qd[j];
    signals_[layout.joint[j] + 2] = sensors.tau[j];
    signals_[layout.joint[j] + 4] = sensors.motor_torque[j];
  }
}

void SignalWriter::write_quality(const EstimateQuality& quality) noexcept {
  const behaviors::EstimateSignals& out = behavior_.layout.estimate;
  if (out.markers < 0) return;
  put(signals_, out.gyro_bias, quality.gyro_bias);
  put(signals_, out.accelerometer_bias, quality.accelerometer_bias);
  put(signals_, out.attitude, quality.attitude);
  put(signals_, out.position, quality.position);
  put(signals_, out.velocity, quality.velocity);
  signals_[out.markers] = quality.markers;
  signals_[out.marker_innovation] = quality.marker_innovation;
  signals_[out.kinematic_innovation] = quality.kinematic_innovation;
}

void SignalWriter::write_truth(const model::ControlModel& model,
                               const hal::Sensors& sensors) noexcept {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  constexpr std::array<double, 3> kNone = {kUnknown, kUnknown, kUnknown};
  const behaviors::TruthSignals& out = behavior_.layout.truth;
  if (out.com_pos < 0) return;
  Truth truth{kNone, kNone, kNone, kNone};
  if (sensors.has_truth) truth = truth_of(sensors, model);
  put(signals_, out.com_pos, truth.com);
  put(signals_, out.base_pos, truth.p_WB);
  put(signals_, out.base_vel, truth.v_WB);
  put(signals_, out.base_rpy, truth.rpy);
  put(signals_, out.gyro_bias, sensors.sensor_truth ? sensors.true_gyro_bias : kNone);
  put(signals_, out.accelerometer_bias,
      sensors.sensor_truth ? sensors.true_accelerometer_bias : kNone);
}

void SignalWriter::write_control(const behaviors::Machine& machine,
                                 const tasks::ControllerResult& result,
                                 const hal::Commands& commands, double torque_step,
                                 const core::FaultCounters& counters) noexcept {
  const behaviors::SignalLayout& layout = behavior_.layout;
  const tasks::ActiveControl& control = machine.control();
  for (std::size_t c = 0; c < layout.support.size(); ++c) {
    signals_[layout.support[c]] = 0.0;
    put(signals_, layout.force_cmd[c], result.force[c]);
    put(signals_, layout.force_est[c], result.force_measured[c]);
  }
  for (int i = 0; i < control.primary.contact_count; ++i) {
    signals_[layout.support[at(control.primary.contacts[at(i)])]] = 1.0;
  }
  for (std::size_t j = 0; j < layout.joint.size(); ++j) {
    signals_[layout.joint[j] + 3] = commands.tau[j];
  }
  const auto active = machine.active_atomic();
  signals_[layout.state] = active.empty() ? -1.0 : active.front();
  signals_[layout.transition_weight] = control.has_other ? control.other_weight : 0.0;
  signals_[layout.torque_step] = torque_step;
  if (!behavior_.planners.empty() && behavior_.planners.front().goal_slot >= 0) {
    const auto slot = at(behavior_.planners.front().goal_slot);
    signals_[layout.goal] = machine.parameters()[slot];
    signals_[layout.goal + 1] = machine.parameters()[slot + 1];
  }
  double faults = 0.0;
  for (const std::int64_t n : counters.count) faults += static_cast<double>(n);
  signals_[layout.faults] = faults;
  signals_[layout.tick_late] = static_cast<double>(counters.of(core::Fault::tick_overrun));
  if (machine.control_spec() != control_) {
    leave_gaps();
    control_ = machine.control_spec();
  }
  write_internals(control.primary, result);
  write_tasks(control.primary, result);
}

// What is not in force has no value: a gap in the log, false in a condition.
void SignalWriter::leave_gaps() noexcept {
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
void SignalWriter::write_internals(const tasks::ControlSet& set,
                                   const tasks::ControllerResult& result) noexcept {
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
    signals_[out.reference] = result.internal_reference[at(i)] / c.scale;
    signals_[out.measured] = sum / pairs / c.scale;
    internal_in_force_[at(c.instance)] = 1;
  }
}

void SignalWriter::write_tasks(const tasks::ControlSet& set,
                               const tasks::ControllerResult& result) noexcept {
  const behaviors::SignalLayout& layout = behavior_.layout;
  for (int k = 0; k < 3; ++k) signals_[layout.com_ref + k] = signals_[layout.com_pos + k];
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

// By name; what the old behavior has not, is not in force yet.
void SignalWriter::take_over(const SignalWriter& old, const behaviors::TakeOverMap& map) noexcept {
  for (auto* in_force : {&task_in_force_, &internal_in_force_}) {
    std::ranges::fill(*in_force, static_cast<unsigned char>(1));
  }
  leave_gaps();
  for (std::size_t s = 0; s < map.signals.size(); ++s) {
    if (map.signals[s] >= 0) signals_[map.signals[s]] = old.signals_.values()[s];
  }
  for (auto* in_force : {&task_in_force_, &internal_in_force_}) {
    std::ranges::fill(*in_force, static_cast<unsigned char>(1));
  }
  control_ = -1;
}

}  // namespace footfall::engine
