// Pushes of the MuJoCo backend.
#include <cmath>
#include <numbers>

#include "tests/unit/sim/mujoco_test_support.h"

namespace footfall::tests {
namespace {

// Momentum of free flight changes by force times time, and by gravity. Internal forces cancel in
// continuous time; a first-order step of 1/3000 s leaves of each velocity change (0.4 m/s of the
// torso, in 300 steps) a relative error of the order of step times rotation (about 3 rad/s): 1e-3.
TEST_F(Mujoco, APushChangesTheMomentumByForceTimesTimeAndFollowsTheHeading) {
  for (const double yaw : {0.0, 0.5, std::numbers::pi / 2, -2.5}) {
    for (const double direction : {0.0, std::numbers::pi / 2, 2.0}) {
      auto backend = started();
      backend.start();
      lift(backend);
      backend.data()->qpos[3] = std::cos(0.5 * yaw);
      backend.data()->qpos[6] = std::sin(0.5 * yaw);
      mj_forward(backend.model(), backend.data());
      const Vector3 before = momentum(backend);
      ASSERT_TRUE(backend.push(backend.find_body("torso"), 40.0, direction, 0.1));
      for (int k = 0; k < 225; ++k) backend.write({});  // 0.15 s: it ended
      mj_forward(backend.model(), backend.data());
      const Vector3 after = momentum(backend);
      const double wanted = 40.0 * 0.1;
      const double tolerance = 2e-3 * wanted;
      EXPECT_NEAR(after[0] - before[0], wanted * std::cos(yaw + direction), tolerance);
      EXPECT_NEAR(after[1] - before[1], wanted * std::sin(yaw + direction), tolerance);
      const double weight = backend.facts().mass * 9.81;
      EXPECT_NEAR(after[2] - before[2], -weight * 0.15, 2e-3 * weight * 0.15);
    }
  }
}

// Downwards, 0.2 m in front of the torso's frame: impulse, and its moment about the whole CoM, from
// the places at the beginning (the robot turns by some mrad meanwhile: 2 %).
TEST_F(Mujoco, APushCanPointDownwardsAndActOnAnyPointOfTheBody) {
  auto backend = started();
  backend.start();
  lift(backend);
  const std::array<double, 3> point = {0.2, 0.0, 0.3};
  const auto turning = [&] {
    mj_forward(backend.model(), backend.data());
    mj_subtreeVel(backend.model(), backend.data());
    const double* h = backend.data()->subtree_angmom + 3;
    return Vector3{h[0], h[1], h[2]};
  };
  const Vector3 before = momentum(backend), turned = turning();
  const int torso = backend.find_body("torso");
  const double ahead = backend.data()->xpos[3 * torso] + point[0] - backend.data()->subtree_com[3];
  ASSERT_TRUE(backend.push(torso, 40.0, 0.0, 0.02, -std::numbers::pi / 2, point));
  for (int k = 0; k < 30; ++k) backend.write({});
  const Vector3 now = turning(), after = momentum(backend);
  const double weight = backend.facts().mass * 9.81;
  EXPECT_NEAR(after[2] - before[2], -0.8 - weight * 0.02, 2e-3 * weight * 0.02);
  EXPECT_NEAR(after[0] - before[0], 0.0, 1e-3);
  EXPECT_NEAR(now[1] - turned[1], ahead * 0.8, 0.02 * ahead * 0.8);
}

// Less than a physics step of 1/3000 s; one and a half; 30 and a bit.
TEST_F(Mujoco, APushOfNoWholeNumberOfPhysicsStepsKeepsItsImpulse) {
  for (const double duration : {1e-6, 5e-4, 0.0101}) {
    auto backend = started();
    backend.start();
    lift(backend);
    const Vector3 before = momentum(backend);
    ASSERT_TRUE(backend.push(backend.find_body("torso"), 1.0 / duration, 0.0, duration));
    for (int k = 0; k < 30; ++k) backend.write({});
    mj_forward(backend.model(), backend.data());
    EXPECT_NEAR(momentum(backend)[0] - before[0], 1.0, 2e-3) << duration;
  }
}

TEST_F(Mujoco, PushesThatOverlapOnABodyAddUp) {
  auto backend = started();
  backend.start();
  lift(backend);
  const int torso = backend.find_body("torso");
  ASSERT_TRUE(backend.push(torso, 10.0, 0.0, 0.02));
  ASSERT_TRUE(backend.push(torso, 5.0, 0.0, 0.04));
  ASSERT_TRUE(backend.push(torso, 2.0, 0.0, 0.01));
  ASSERT_TRUE(backend.push(torso, 2.0, std::numbers::pi, 0.01));
  for (std::size_t k = 4; k < sim::kMaxPushes; ++k) {
    ASSERT_TRUE(backend.push(torso, 0.0, 0.0, 0.01)) << k;
  }
  EXPECT_FALSE(backend.push(torso, 1.0, 0.0, 0.02)) << "one too many";
  std::vector<double> force;
  for (int tick = 0; tick < 75; ++tick) {
    backend.write({});
    force.push_back(backend.data()->xfrc_applied[6 * torso]);
  }
  EXPECT_NEAR(force[5], 15.0, 1e-12);
  EXPECT_NEAR(force[20], 15.0, 1e-12);
  EXPECT_NEAR(force[40], 5.0, 1e-12);
  EXPECT_EQ(force[70], 0.0);
}

}  // namespace
}  // namespace footfall::tests
