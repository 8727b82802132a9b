// Series-elastic actuators in the simulated robot: what acts on the joints, what is measured of it.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "sim/mujoco_backend.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

sim::WorldDescription elastic_world(const std::string& more = "") {
  const auto path = std::filesystem::path(testing::TempDir()) / "elastic.yaml";
  std::ofstream(path) << "world: 1\nactuators: {model: series_elastic" << more << "}\n";
  core::Diagnostics diagnostics;
  auto world = sim::load_world(path.string(), diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  return world;
}

class ElasticActuators : public testing::Test {
 protected:
  // In the air; nothing else acts on its joints.
  void start(const sim::WorldDescription& world) {
    backend = std::make_unique<sim::MujocoBackend>(robot, world);
    backend->start();
    backend->data()->qpos[2] += 100.0;
    mj_forward(backend->model(), backend->data());
    backend->read(sensors);
  }
  void run(double torque, int ticks) {
    hal::Commands commands;
    commands.tau[kKneeJoint] = torque;
    for (int k = 0; k < ticks; ++k) {
      backend->write(commands);
      backend->read(sensors);
    }
  }
  double applied() { return backend->data()->qfrc_applied[6 + kKneeJoint]; }

  static constexpr int kKneeJoint = 2;
  model::RobotDescription robot = load_hume();
  std::unique_ptr<sim::MujocoBackend> backend;
  hal::Sensors sensors;
};

// After the lag of the loop (3.6 ms at 44 Hz) the rotor turns with the joint: of u = τ_d + P e it
// takes J θ'' = (1 + P) e to accelerate it.
TEST_F(ElasticActuators, TorqueFollowsItsCommandWithTheLagOfTheLoop) {
  start(elastic_world());
  run(2.0, 3);  // 2 ms
  EXPECT_GT(sensors.tau[kKneeJoint], 0.1);
  EXPECT_LT(sensors.tau[kKneeJoint], 1.5);
  run(2.0, 57);  // 40 ms
  const double before = sensors.qd[kKneeJoint];
  run(2.0, 1);
  const double acceleration = (sensors.qd[kKneeJoint] - before) * 1500.0;
  const double missing = robot.joints[kKneeJoint].rotor * acceleration / 21.0;
  EXPECT_GT(missing, 0.2);
  EXPECT_NEAR(sensors.tau[kKneeJoint], 2.0 - missing, 0.1 * missing);
  EXPECT_NEAR(applied(), sensors.tau[kKneeJoint], 0.02);
}

TEST_F(ElasticActuators, ACommandActsAfterItsDelay) {
  for (const int late : {1, 2, 5}) {
    start(elastic_world(", command_delay: " + std::to_string(late * 1e3 / 1500.0) + " ms"));
    run(5.0, late);
    EXPECT_LT(std::abs(applied()), 1e-15) << late;  // rounding of angles
    run(5.0, 1);
    EXPECT_GT(applied(), 1e-3) << late;
  }
}

TEST_F(ElasticActuators, AMeasurementIsOfItsDelayAgo) {
  start(elastic_world(", measurement_delay: " + std::to_string(3e3 / 1500.0) + " ms"));
  std::vector<double> acting;
  for (int k = 0; k < 30; ++k) {
    run(5.0, 1);
    acting.push_back(backend->drive()->actuator(kKneeJoint).spring_torque());
    if (k < 5) continue;
    // Within a step of the loop: the drive measures at the beginning of each.
    EXPECT_NEAR(sensors.tau[kKneeJoint], acting[static_cast<std::size_t>(k - 3)], 0.1) << k;
  }
}

// A spring that is stiffer than the drive counts on carries that much more than is measured.
TEST_F(ElasticActuators, TheMeasuredTorqueCountsOnTheNominalSpring) {
  start(elastic_world(R"(, spring: {"*knee": 20 %, left_knee: 0 %})"));
  run(1.0, 60);
  EXPECT_NEAR(backend->drive()->actuator(kKneeJoint).spring_torque() / sensors.tau[kKneeJoint], 1.2,
              0.02);
  EXPECT_DOUBLE_EQ(backend->drive()->actuator(5).parameters().spring, robot.joints[5].spring);
}

TEST_F(ElasticActuators, WhatASeedDrewOfSpringsAndFrictionIsInTheDrive) {
  model::Draw drawn;
  drawn.springs = {1.0, 1.0, 0.97, 1.0, 1.0, 1.0};
  drawn.coulomb = {1.0, 1.0, 1.3, 1.0, 1.0, 1.0};
  start(sim::with_draw(elastic_world(", spring: 10 %, coulomb: 2 Nm"), drawn));
  const hal::SeriesElasticParameters& knee = backend->drive()->actuator(kKneeJoint).parameters();
  EXPECT_DOUBLE_EQ(knee.spring, 0.97 * 1.1 * robot.joints[kKneeJoint].spring);
  EXPECT_DOUBLE_EQ(knee.coulomb, 2.6);
}

// The springs act inside the robot: its momentum is that of free fall.
TEST_F(ElasticActuators, SpringsDoNotChangeTheRobotsMomentum) {
  start(elastic_world(", coulomb: 1 Nm, viscous: 0.5 Nm s/rad"));
  run(3.0, 150);
  mj_forward(backend->model(), backend->data());  // velocities of now, not of the step before
  mj_subtreeVel(backend->model(), backend->data());
  const double* v = backend->data()->subtree_linvel + 3;
  EXPECT_NEAR(v[0], 0.0, 2e-3);  // semi-implicit Euler does not conserve it exactly
  EXPECT_NEAR(v[1], 0.0, 2e-3);
  EXPECT_NEAR(v[2], -9.81 * 0.1, 2e-3);
}

// A motor's limit in the model is that of the command, not of the spring behind it.
TEST_F(ElasticActuators, ASpringIsNotClampedAtTheMotorsLimitInTheModel) {
  start(elastic_world());
  for (int k = 0; k < 3; ++k) run(95.0, 1);
  run(100.0, 12);
  double most = 0.0;
  for (int k = 0; k < 30; ++k) {
    run(100.0, 1);
    EXPECT_DOUBLE_EQ(backend->data()->qfrc_actuator[6 + kKneeJoint], 0.0);
    most = std::max(most, applied());
  }
  EXPECT_GT(most, 50.0);
}

// The joint's encoder is before the link that bends: it shows the torque over the link's stiffness
// more than where the link's end is, and the drive measures what its own spring carries.
TEST_F(ElasticActuators, AFlexibleLinkBendsBehindTheJointsEncoder) {
  start(elastic_world(", flexible: {right_knee: 500 Nm/rad}"));
  run(2.0, 40);
  const double torque = backend->drive()->actuator(kKneeJoint).spring_torque();
  EXPECT_GT(torque, 1.0);
  EXPECT_NEAR(sensors.q[kKneeJoint] - backend->data()->qpos[7 + kKneeJoint], torque / 500.0, 2e-4);
  EXPECT_NEAR(sensors.tau[kKneeJoint], torque, 0.02);
  const double together = 415.0 * 500.0 / 915.0;
  EXPECT_DOUBLE_EQ(backend->drive()->actuator(kKneeJoint).parameters().spring, together);
  EXPECT_EQ(sensors.q[0], backend->data()->qpos[7]);
}

TEST_F(ElasticActuators, ATiltedAxisTurnsWhatHangsOnItInTheSimulationOnly) {
  sim::WorldDescription world = elastic_world();
  core::Diagnostics diagnostics;
  world.axis_tilts.node = core::load_yaml_text("{right_hip: 0.06}", "w", diagnostics);
  start(world);
  const mjModel* m = backend->model();
  const double* quat = m->body_quat + 4 * backend->find_body("right_thigh");
  EXPECT_NEAR(quat[0], std::cos(0.03), 1e-12);
  EXPECT_NEAR(quat[3], std::sin(0.03), 1e-12);
  EXPECT_EQ(m->body_quat[4 * backend->find_body("left_thigh")], 1.0);
}

TEST_F(ElasticActuators, ASafeStopReleasesTheSprings) {
  start(elastic_world());
  run(5.0, 60);
  backend->safe_stop();
  run(5.0, 150);
  EXPECT_LT(std::abs(sensors.tau[kKneeJoint]), 0.5);
}

TEST_F(ElasticActuators, ATickAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  start(elastic_world(", coulomb: 1 Nm, command_delay: 1 ms, motor_resolution: 1e-5 rad"));
  hal::Commands commands;
  const AllocationGuard guard;
  for (int k = 0; k < 10; ++k) {
    backend->write(commands);
    backend->set_torque_loop(1, robot.drives.torque_loop[2]);
    backend->read(sensors);
  }
  EXPECT_EQ(guard.allocations(), 0);
}

std::string problems_with(const model::RobotDescription& robot,
                          const sim::WorldDescription& world) {
  core::Diagnostics diagnostics;
  sim::check_actuators(world.actuators, robot, world.physics.steps_per_tick, diagnostics);
  std::string text;
  for (const core::Diagnostic& item : diagnostics.all()) text += item.text + "\n";
  return text;
}

TEST_F(ElasticActuators, WhatTheRobotLacksForThemIsToldWithTheWorldsPlace) {
  EXPECT_EQ(problems_with(robot, elastic_world()), "");
  EXPECT_EQ(problems_with(robot, elastic_world(", spring: {knie: 1 %}")),
            "no joint 'knie': there are right_abduction, right_hip, right_knee, "
            "left_abduction, left_hip, left_knee\n");
  model::RobotDescription other = robot;
  other.drives.rate = 10'000.0;
  EXPECT_EQ(problems_with(other, elastic_world()),
            "the torque loops run at 10000 Hz ('drives: {rate: ...}' of robot 'hume'), the physics "
            "at 3000 Hz: expected a whole multiple\n");
  other.drives.torque_loop.clear();
  other.joints[1].rotor = 0.0;
  EXPECT_EQ(problems_with(other, elastic_world()),
            "series-elastic actuators need 'sea: {spring: ..., rotor: ...}' of every joint: robot "
            "'hume' has none at 'right_hip'\n");
}

}  // namespace
}  // namespace footfall::tests
