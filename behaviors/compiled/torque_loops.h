// The gains of the actuators' torque loops that a control asks for.
#pragma once

#include <span>

#include "behaviors/compiled/behavior.h"
#include "hal/actuators/torque_loop.h"

namespace footfall::behaviors {

// The gains of a joint with `values` (of Behavior::values, by slot): of the control's table;
// without one the robot's own, or the default gains if the robot has none. No allocation; safe for
// the tick.
hal::TorqueLoopGains torque_loop_gains(const Behavior& behavior, const ControlSpec& control,
                                       int joint, std::span<const double> values) noexcept;
// The same for a table, an index into Behavior::torque_loops or -1.
hal::TorqueLoopGains torque_loop_gains(const Behavior& behavior, int table, int joint,
                                       std::span<const double> values) noexcept;

}  // namespace footfall::behaviors
