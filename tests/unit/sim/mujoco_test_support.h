// MuJoCo as a backend, for its tests.
#pragma once

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>

#include "sim/mujoco_backend.h"
#include "tests/support/hume.h"

namespace footfall::tests {

using Vector3 = std::array<double, 3>;

class Mujoco : public testing::Test {
 protected:
  model::RobotDescription robot = load_hume();

  sim::MujocoBackend started(const sim::WorldDescription& world = {}) {
    return sim::MujocoBackend(robot, world);
  }
  // High above the ground, so that nothing touches for a second.
  static void lift(sim::MujocoBackend& backend) {
    backend.data()->qpos[2] += 10.0;
    mj_forward(backend.model(), backend.data());
  }
  static Vector3 momentum(sim::MujocoBackend& backend) {
    mj_subtreeVel(backend.model(), backend.data());
    const double mass = backend.model()->body_subtreemass[1];
    const double* v = backend.data()->subtree_linvel + 3;
    return {mass * v[0], mass * v[1], mass * v[2]};
  }
};

}  // namespace footfall::tests
