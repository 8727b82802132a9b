// Where a contact is and how it moves relative to the base, from this tick's joints and the model
// of the last tick.
#pragma once

#include "engine/estimators/parts/rotation.h"
#include "model/control_model.h"

namespace footfall::engine {

// In base axes, relative to the base's origin. The contact point is the material point of the foot
// that touches the believed ground: its centre less the radius along the ground's normal.
struct FootKinematics {
  Vector3d contact = Vector3d::Zero();   // m, of the contact point
  Vector3d velocity = Vector3d::Zero();  // m/s, J_leg q̇: of that material point, joints alone
  Vector3d spin = Vector3d::Zero();      // rad/s, of the foot's link against the world
};

// `state` has this tick's joints. Positions are the model's, moved on by its Jacobian; the
// remainder is second order in a tick's motion.
FootKinematics foot_kinematics(const model::ControlModel& model, int contact,
                               const model::State& state) noexcept;

}  // namespace footfall::engine
