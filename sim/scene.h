// The simulated world as one MJCF text: the robot's file, the ground, terrain, physics settings.
#pragma once

#include <string>

#include "model/robot/description.h"
#include "sim/world/description.h"

namespace footfall::sim {

// A complete MJCF document for physics, without visual-only shapes, which would cost two thirds of
// a step.
std::string scene_xml(const model::RobotDescription& robot, const WorldDescription& world);

}  // namespace footfall::sim
