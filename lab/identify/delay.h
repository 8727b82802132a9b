// The delay of an actuator's command: that with which its torque loop's law explains the motor
// torque. Pure functions; after a run.
#pragma once

#include <span>

#include "hal/actuators/drive.h"
#include "lab/identify/actuator.h"

namespace footfall::lab {

struct LoopRecord {
  hal::TorqueLoopGains gains;
  double rotor = 0.0;  // kg m^2, as the loop knows it
  hal::RateFilters filters;
  std::vector<double> command;  // N m, by tick
  std::vector<char> saturated;  // by tick: the motor gave less than asked in the tick before
};

struct DelayEstimate {
  bool known = false;      // the law explains the motor torque
  Estimate delay;          // s, from the tick's write to the motor torque, as the log has it
  double explained = 0.0;  // part of the variance of the motor torque above kHighPass
  // If known, by tick: for ActuatorRecord::moment.
  std::vector<double> moment;
};

// Below this part the law is not the one that ran.
inline constexpr double kLeastExplained = 0.6;
inline constexpr double kHighPass = 1.0;    // Hz: drift of integrals is no matter
inline constexpr double kMostDelay = 0.04;  // s

DelayEstimate identify_delay(const ActuatorRecord& record, const LoopRecord& loop);

}  // namespace footfall::lab
