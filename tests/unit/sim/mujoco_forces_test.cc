// What acts on the robot from outside: people who hold it.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "sim/mujoco_backend.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

// Without torque the robot would fold up; its weight moves the hands by g/w^2 = 4 mm, and no
// further while it settles, since they are critically damped: twice that for the legs that swing,
// and again.
TEST(MujocoForces, AHeldBodyStaysWhereItIsUntilItIsLetGo) {
  const model::RobotDescription robot = load_hume();
  sim::MujocoBackend backend(robot, sim::WorldDescription());
  backend.start();
  const int torso = backend.find_body(robot.floating_base);
  const double* p = backend.data()->qpos;
  const std::array<double, 3> before = {p[0], p[1], p[2]};
  model::BodySprings whole;
  whole.all = true;
  const int hold = backend.hold(torso, whole);
  ASSERT_GE(hold, 0);
  for (int k = 0; k < 1500; ++k) {
    backend.write({});
    ASSERT_LT(std::hypot(p[0] - before[0], p[1] - before[1], p[2] - before[2]), 0.016) << k;
    ASSERT_GT(std::abs(p[3]), std::cos(0.1)) << k;  // half the angle: turned by less than 0.2 rad
  }
  backend.release(hold);
  for (int k = 0; k < 1500; ++k) backend.write({});
  EXPECT_LT(p[2], before[2] - 0.1);
}

}  // namespace
}  // namespace footfall::tests
