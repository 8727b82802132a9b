// The postures at which a behavior's physics is checked. Load time only.
#pragma once

#include <vector>

#include "model/robot/description.h"
#include "model/state.h"

namespace footfall::behaviors {

inline constexpr int kSeededPostures = 20;

// At rest: the robot file's nominal posture with the base upright at its standing height, then
// kSeededPostures around it, the same in every run. Each joint is drawn uniformly within 0.2 rad of
// its nominal angle and then limited to its range; the base is tilted by up to 0.1 rad about the
// horizontal axes and turned by up to 0.5 rad. Rank and freedom depend on the positions of the
// contact points, not on whether they are all on the ground, so the feet are not moved to the
// ground.
std::vector<model::State> physics_postures(const model::RobotDescription& robot);

}  // namespace footfall::behaviors
