// The last word before the hardware: finite, within limits, not falling. Pure state, no clock.
#pragma once

#include <array>
#include <vector>

#include "core/fault.h"
#include "hal/hardware.h"
#include "model/control_model.h"
#include "model/robot_description.h"

namespace footfall::engine {

// What the filter found in one tick, as a set of faults.
struct SafetyFindings {
  std::array<bool, core::kFaultCount> found{};
  bool any = false;
  void add(core::Fault fault) noexcept {
    found[static_cast<std::size_t>(fault)] = true;
    any = true;
  }
  bool has(core::Fault fault) const noexcept { return found[static_cast<std::size_t>(fault)]; }
};

class SafetyFilter {
 public:
  explicit SafetyFilter(const model::RobotDescription& robot);

  // Before control: fall (height of the base above the lowest contact point below its part of the
  // standing height, tilt beyond the limit, another body touching), joint limits, backend faults.
  SafetyFindings check_state(const hal::Sensors& sensors,
                             const model::ControlModel& model) noexcept;

  // After control: replaces what is not finite by 0, clamps to the limits, counts torque steps.
  // `first` suppresses the step check of the first tick.
  SafetyFindings filter(hal::Commands& commands) noexcept;

  double torque_step() const noexcept { return torque_step_; }  // N m, largest of the last tick

 private:
  const model::RobotDescription& robot_;
  std::array<double, core::kMaxJoints> previous_{};
  bool have_previous_ = false;
  double torque_step_ = 0.0;
};

}  // namespace footfall::engine
