// Columns and files of a log as records of actuators; see logged.h.
#include "lab/identify/logged.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <stdexcept>

#include "behaviors/compiled/torque_loops.h"
#include "core/index.h"
#include "engine/tick/input_row.h"
#include "hal/sensor_fields.h"
#include "lab/replay/replay.h"

namespace footfall::lab {
namespace {

constexpr std::uint64_t kSaturatedBit = 64;  // of the flags, hal/sensor_fields.h

std::optional<int> column_of(const LoggedInputs& inputs, std::string_view name) {
  const auto found = std::ranges::find(inputs.columns, name);
  if (found == inputs.columns.end()) return std::nullopt;
  return static_cast<int>(found - inputs.columns.begin());
}

std::vector<double> values_of(const Log& log, const std::string& name) {
  const auto column = column_of(log.inputs, name);
  if (!column) {
    throw std::runtime_error(fmt::format(
        "the log '{}' has no '{}': it is from a version without series-elastic actuators", log.path,
        name));
  }
  std::vector<double> out;
  const std::int64_t first = log.inputs.first_tick;
  for (std::int64_t tick = std::max<std::int64_t>(0, first); tick < first + log.inputs.ticks();
       ++tick) {
    out.push_back(std::bit_cast<double>(log.inputs.row(tick)[*column]));
  }
  return out;
}

std::vector<char> saturated(const Log& log) {
  const auto column = column_of(log.inputs, engine::InputLayout::kFlagsColumn);
  std::vector<char> out;
  const std::int64_t first = log.inputs.first_tick;
  for (std::int64_t tick = std::max<std::int64_t>(0, first); tick < first + log.inputs.ticks();
       ++tick) {
    out.push_back((log.inputs.row(tick)[column.value_or(0)] & kSaturatedBit) != 0 ? 1 : 0);
  }
  return out;
}

bool all_zero(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return value == 0.0; });
}

// The gains of a joint if they are the same in every state of the run.
std::optional<hal::TorqueLoopGains> constant_gains(const behaviors::Behavior& behavior, int joint,
                                                   bool edited) {
  if (!behavior.torque_loops.empty() && edited) return std::nullopt;
  std::optional<hal::TorqueLoopGains> gains;
  for (const behaviors::ControlSpec& control : behavior.controls) {
    const auto here = behaviors::torque_loop_gains(behavior, control, joint, behavior.values);
    if (gains && !(*gains == here)) return std::nullopt;
    gains = here;
  }
  return gains;
}

LoggedActuator actuator_of(const Log& log, const behaviors::Behavior& behavior, int joint) {
  const model::JointDescription& description = behavior.robot.joints[at(joint)];
  LoggedActuator out;
  out.joint = description.name;
  out.spring = description.spring;
  out.rotor = description.rotor;
  out.record.period = behavior.robot.period_s();
  out.record.drive_step = 1.0 / behavior.robot.drives.rate;
  out.record.nominal_spring = description.spring;
  out.record.torque = values_of(log, "tau." + out.joint);
  out.record.motor = values_of(log, "motor." + out.joint);
  out.record.motor_torque = values_of(log, "motor_torque." + out.joint);
  out.loop.rotor = description.rotor;
  out.loop.filters = behavior.robot.drives.filters;
  out.loop.command = values_of(log, "command." + out.joint);
  out.loop.saturated = saturated(log);
  const auto gains = constant_gains(behavior, joint, !log.edits.empty());
  if (behavior.robot.drives.torque_loop.empty() && behavior.torque_loops.empty()) {
    out.unknown_loop = "the robot file has no gains of the torque loops";
  } else if (!gains) {
    out.unknown_loop = "the behavior changes the torque loop's gains";
  } else {
    out.loop.gains = *gains;
  }
  return out;
}

}  // namespace

std::vector<LoggedActuator> logged_actuators(const Log& log) {
  if (log.inputs.ticks() == 0) {
    throw std::runtime_error(fmt::format("the log '{}' has no inputs", log.path));
  }
  const Replay replay(log);
  const behaviors::Behavior& behavior = replay.behavior();
  std::vector<LoggedActuator> out;
  bool elastic = false;
  for (int joint = 0; joint < behavior.robot.joint_count(); ++joint) {
    if (!(behavior.robot.joints[at(joint)].spring > 0.0)) continue;
    out.push_back(actuator_of(log, behavior, joint));
    elastic |= !all_zero(out.back().record.motor);
  }
  if (!elastic) {
    throw std::runtime_error(
        fmt::format("the actuators of the log '{}' were ideal: expected a run with series-elastic "
                    "ones, such as `footfall run excite --world sea_hoist`",
                    log.path));
  }
  return out;
}

IdentifiedActuator identify(const LoggedActuator& logged) {
  IdentifiedActuator out;
  out.no_delay = logged.unknown_loop;
  ActuatorRecord record = logged.record;
  if (out.no_delay.empty()) {
    out.delay = identify_delay(record, logged.loop);
    if (!out.delay.known) {
      out.no_delay = fmt::format("the torque loop's law explains only {:.0f} % of the motor torque",
                                 100.0 * out.delay.explained);
    }
    record.moment = std::move(out.delay.moment);
  }
  out.actuator = identify_actuator(record);
  return out;
}

}  // namespace footfall::lab
