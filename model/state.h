// The robot's state as the estimator gives it.
#pragma once

#include <array>

#include "core/capacities.h"

namespace footfall::model {

// Configuration and velocity. Generalised velocity order everywhere: base linear velocity (world
// axes, of the base origin), base angular velocity (BODY axes), then joints in MuJoCo's order,
// which the loader requires to be the robot file's order.
struct State {
  std::array<double, 3> p_WB{};            // m
  std::array<double, 4> q_WB{1, 0, 0, 0};  // w x y z
  std::array<double, 3> v_WB{};            // m/s, world
  std::array<double, 3> w_WB_B{};          // rad/s, body
  std::array<double, core::kMaxJoints> q{};
  std::array<double, core::kMaxJoints> qd{};
};

}  // namespace footfall::model
