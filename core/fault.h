// Run-time faults and the reactions to them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace footfall::core {

// Run-time faults; their dotted names are used in robot files, logs and as events `fault.NAME`.
enum class Fault : std::uint8_t {
  fall,               // torso too low or tilted too far, or a body other than a foot touches
  non_finite,         // a state or torque is NaN or infinite
  torque_limit,       // a commanded torque reaches the joint's limit (clamped)
  torque_step,        // a torque changes between two ticks by more than the robot's limit
  joint_limit,        // a joint exceeds its position limits
  swing_too_long,     // a foot is in the air for longer than `limits.swing` while stepping
  simulator_warning,  // a MuJoCo warning, reset or bad value
  sensor_stale,       // no new sensor data
  imu_stale,          // no new IMU data
  mocap_stale,        // no new motion capture data
  tick_overrun,       // the tick missed its deadline
  planner_late,       // no plan arrived by its deadline
  execution,          // error.execution of the statechart
  event_overflow,     // an event queue is full
  rank_loss,          // a task level lost rank that it has at load
  no_estimate,        // the estimator cannot give a state
  script_stuck,       // a script does not come back from a call
  swing_contact,      // a foot that should swing bears load for more than half of its phase
  condition,          // a task level is worse conditioned than `limits.condition`
  load_air,           // a foot that swung is loaded without ground contact
  sensor_clock,       // the sensors' clock jumps or stands still
  sensor_nan,         // a measured value that the estimator uses is NaN or infinite
  slip,               // a foot of the control law slides along the ground
  count
};
inline constexpr int kFaultCount = static_cast<int>(Fault::count);

// The reaction to a fault, configured in the robot file.
enum class Reaction : std::uint8_t { keep_going, safe_state, safe_stop };

// Dotted name, e.g. "torque.limit".
constexpr std::string_view fault_name(Fault fault) {
  constexpr std::array<std::string_view, kFaultCount> names = {
      "fall",      "non_finite",     "torque.limit", "torque.step", "joint.limit",  "swing.long",
      "simulator", "sensor.stale",   "imu.stale",    "mocap.stale", "tick.overrun", "planner.late",
      "execution", "event.overflow", "rank.loss",    "no_estimate", "script.stuck", "swing.contact",
      "condition", "load.air",       "sensor.clock", "sensor.nan",  "slip"};
  return names[static_cast<std::size_t>(fault)];
}

// Fault counters of one run: how often each appeared, and in how many ticks it was there.
struct FaultCounters {
  std::array<std::int64_t, kFaultCount> count{}, ticks{};
  void add(Fault fault) noexcept { ++count[static_cast<std::size_t>(fault)]; }
  void add_tick(Fault fault) noexcept { ++ticks[static_cast<std::size_t>(fault)]; }
  std::int64_t of(Fault fault) const noexcept { return count[static_cast<std::size_t>(fault)]; }
  std::int64_t ticks_of(Fault fault) const noexcept {
    return ticks[static_cast<std::size_t>(fault)];
  }
};

}  // namespace footfall::core
