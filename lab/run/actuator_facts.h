// What a run's log says of its series-elastic actuators: each torque loop that a joint can have.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "behaviors/compiled/behavior.h"

namespace footfall::lab {

// A list of {joint, table, type, bandwidth_Hz, passivity_margin}: the robot's own gains (table
// "drives") where a law leaves them to a joint, and those of tables that a law gives it, as at the
// start of a run. bandwidth: output locked; margin: 0 or more is passive. Nominal springs, no
// friction.
nlohmann::ordered_json actuator_facts(const behaviors::Behavior& behavior);

}  // namespace footfall::lab
