// The torque loops that a robot's drives start with, as `footfall check` and runs on series-elastic
// actuators judge them. Load time only.
#pragma once

#include "core/diagnostics/diagnostics.h"
#include "model/robot/description.h"

namespace footfall::behaviors {

// Reports gains whose sampled loop, output locked, grows: an error at the section `drives` of the
// robot's file. What is not given is not judged.
void check_drives(const model::RobotDescription& robot, core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
