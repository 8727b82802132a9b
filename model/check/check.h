// Finds what of a robot's MJCF acts in the simulator and not in the control model, or the other way
// round: actuators that are no plain motors, passive forces, constraints, collision settings that
// the ground does not meet, settings of the physics engine. Load time only; `footfall check` and
// `footfall run` call it.
#pragma once

#include "core/diagnostics/diagnostics.h"
#include "model/robot/description.h"

namespace footfall::model {

// Reports at the element's line and column: an error for what no behavior can cope with, a warning
// for what makes the control model inaccurate. False if MuJoCo cannot compile the model.
bool check_model(const RobotDescription& robot, core::Diagnostics& diagnostics);

}  // namespace footfall::model
