// What a log has of each series-elastic actuator.
#pragma once

#include <string>
#include <vector>

#include "lab/identify/actuator.h"
#include "lab/identify/delay.h"
#include "lab/log/reader.h"

namespace footfall::lab {

struct LoggedActuator {
  std::string joint;
  double spring = 0.0, rotor = 0.0;  // of the robot file
  ActuatorRecord record;
  LoopRecord loop;
  std::string unknown_loop;  // why the law of its torque loop is not known; empty: it is
};

// log: read with inputs. In the robot's order. Throws std::runtime_error with one sentence if the
// log has no inputs, or its actuators were ideal.
std::vector<LoggedActuator> logged_actuators(const Log& log);

// Both identifications of one joint.
struct IdentifiedActuator {
  ActuatorEstimate actuator;
  DelayEstimate delay;
  std::string no_delay;  // why the delay is not known; empty: it is
};
IdentifiedActuator identify(const LoggedActuator& logged);

}  // namespace footfall::lab
