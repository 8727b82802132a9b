// The postures at which a behavior's physics is judged. Load time only.
#pragma once

#include <vector>

#include "model/robot/description.h"
#include "model/state.h"

namespace footfall::behaviors {

inline constexpr int kSeededPostures = 20;

// At rest: the robot file's nominal posture with the base upright at its standing height, then
// kSeededPostures around it, the same in every run. Each joint is drawn uniformly within 0.2 rad of
// its nominal angle and then brought within its limits; the base is tilted by up to 0.1 rad about
// the horizontal axes and turned by up to 0.5 rad. Rank and freedom depend on where the contact
// points are, not on whether the ground passes through all of them: the feet are left where the
// joints put them.
std::vector<model::State> physics_postures(const model::RobotDescription& robot);

}  // namespace footfall::behaviors
