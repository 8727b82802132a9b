// The postures at which a behavior's physics is checked. Load time only.
#pragma once

#include <vector>

#include "behaviors/check/physics/check.h"
#include "model/control_model.h"
#include "model/robot/description.h"
#include "model/state.h"

namespace footfall::behaviors {

inline constexpr int kSeededPostures = 20;

// At rest: the posture of the world's start (the robot file's nominal one, or what the world's
// start makes of it) with the base upright, then kSeededPostures around it, the same in every run.
// Each joint is drawn uniformly within 0.2 rad of its angle and then limited to its range; the base
// is tilted by up to 0.1 rad about the horizontal axes and turned by up to 0.5 rad. In the nominal
// posture on level ground the base is at its standing height. Rank and freedom depend on the
// positions of the contact points, not on whether they are all on the ground, so that the feet are
// not moved there; in another posture, or on terrain, the base is where the first ball rests on the
// ground. `model` has the world's terrain; its state changes.
std::vector<model::State> physics_postures(const model::RobotDescription& robot,
                                           model::ControlModel& model, const PhysicsWorld& world);

}  // namespace footfall::behaviors
