// Ropes against closed forms, on a brick: a robot of one body, without joints or contacts.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <fstream>

#include "core/diagnostics/diagnostics.h"
#include "sim/mujoco_backend.h"
#include "sim/springs.h"
#include "sim/springs_check.h"

namespace footfall::sim {
namespace {

constexpr double kRopedMass = 2.0;             // kg
constexpr double kPhysicsStep = 1.0 / 3000.0;  // s

class Ropes : public testing::Test {
 protected:
  Ropes() {
    robot_.name = "brick";
    robot_.path = "brick.yaml";
    robot_.floating_base = "brick";
    robot_.rate_mhz = 1'500'000;
    robot_.model_path = testing::TempDir() + "/footfall_roped_brick.xml";
    std::ofstream(robot_.model_path)
        << "<mujoco><worldbody><body name=\"brick\" pos=\"0 0 10\"><freejoint/>"
           "<inertial pos=\"0 0 0\" mass=\"2\" diaginertia=\"0.01 0.02 0.025\"/>"
           "</body></worldbody></mujoco>";
    world_.physics.steps_per_tick = 2;
  }

  model::BodySprings& aid(const std::string& name = "aid") {
    model::BodySprings& out = world_.constraints.emplace_back();
    out.name = name;
    out.body.name = "brick";
    return out;
  }
  void start() {
    backend_ = std::make_unique<MujocoBackend>(robot_, world_);
    backend_->start();
  }
  double position(int axis) const { return backend_->data()->qpos[axis]; }
  double force(int axis) const { return backend_->data()->xfrc_applied[6 + axis]; }
  void ticks(int count) {
    for (int k = 0; k < count; ++k) backend_->write({});
  }
  std::string refusals() {
    core::Diagnostics found;
    check_springs(world_, {}, robot_, found);
    std::string text;
    for (const core::Diagnostic& item : found.all()) text += item.text + "\n";
    return text;
  }

  model::RobotDescription robot_;
  WorldDescription world_;
  std::unique_ptr<MujocoBackend> backend_;
};

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
