// Whether the physics step integrates external aids stably.
#pragma once

#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "model/aids/springs.h"
#include "model/robot/description.h"
#include "sim/world/description.h"

namespace footfall::sim {

// Reports springs of the world, and of each hold beside them, that are too stiff or too damped for
// the physics step (id "out-of-range"), at the spring. Bodies that the robot lacks are left to
// check_links(). Throws std::runtime_error if the model does not compile.
void check_springs(const WorldDescription& world, const std::vector<model::BodySprings>& holds,
                   const model::RobotDescription& robot, core::Diagnostics& diagnostics);

}  // namespace footfall::sim
