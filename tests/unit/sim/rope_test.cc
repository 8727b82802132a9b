// Ropes against closed forms, on a brick: a robot of one body, without joints or contacts.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "sim/springs.h"
#include "tests/unit/sim/brick.h"

namespace footfall::sim {
namespace {

constexpr double kRopedMass = 2.0;             // kg
constexpr double kPhysicsStep = 1.0 / 3000.0;  // s

using Ropes = Brick;

TEST_F(Ropes, ARopePullsOnlyWhileItIsTautAlongItselfAndAtItsPoint) {
  const ActiveRope rope = {true, {}, {}, 2.0, 1000.0, 50.0};
  EXPECT_EQ(rope_tension(rope, 1.99, 5.0), 0.0);  // slack, although its ends part
  EXPECT_NEAR(rope_tension(rope, 2.1, 0.0), 100.0, 1e-9);
  EXPECT_NEAR(rope_tension(rope, 2.1, 1.0), 150.0, 1e-9);
  EXPECT_EQ(rope_tension(rope, 2.1, -5.0), 0.0);  // it slackens faster than it pulls

  // 3-4-5: from 0.3 m beside the body's origin to a place 4 m above and 3 m ahead of that point.
  model::Rope& own = aid().rope.emplace();
  own.from = {0.0, 0.3, 0.0};
  own.to = {3.0, 0.3, 14.0};
  own.length = 4.9;
  own.stiffness = 1000.0;
  own.damping = 0.0;
  start();
  ticks(1);  // its first physics step has the force of the start
  EXPECT_NEAR(force(0), 60.0, 0.1);
  EXPECT_NEAR(force(1), 0.0, 0.1);
  EXPECT_NEAR(force(2), 80.0, 0.1);
  EXPECT_NEAR(force(3), 0.3 * 80.0, 0.1);  // r x f
  EXPECT_NEAR(force(5), -0.3 * 60.0, 0.1);
  hal::Sensors sensors;
  backend_->read(sensors);
  EXPECT_NEAR(sensors.aid_force[0], 60.0, 0.1);
  EXPECT_NEAR(sensors.aid_force[2], 80.0, 0.1);
}
TEST_F(Ropes, ABodyHungByARopeComesToRestBelowItsEnd) {
  model::Rope& own = aid().rope.emplace();
  own.to = {0.0, 0.0, 12.0};
  own.length = 2.0;
  own.stiffness = 1000.0;
  start();
  ticks(3000);
  EXPECT_NEAR(position(2), 10.0 - kRopedMass * 9.81 / 1000.0, 1e-9);
  hal::Sensors sensors;
  backend_->read(sensors);
  EXPECT_NEAR(sensors.aid_force[2], kRopedMass * 9.81, 1e-6);
}
TEST_F(Ropes, ARopeThatPhysicsCannotIntegrateIsRefused) {
  model::Rope& own = aid().rope.emplace();
  own.damping = 0.0;
  own.stiffness = 0.99 * 4.0 * kRopedMass / (kPhysicsStep * kPhysicsStep);
  EXPECT_EQ(refusals(), "");
  own.from = {0.0, 0.1, 0.0};  // 1/(1/2 + 0.1^2/0.01) = 2/3 kg
  EXPECT_NE(refusals().find("the rope of 'brick' stably"), std::string::npos) << refusals();
  own.stiffness *= 0.33;
  EXPECT_EQ(refusals(), "");
}

}  // namespace
}  // namespace footfall::sim
