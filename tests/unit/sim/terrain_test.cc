// Inclined terrain: what is read, where the simulator has it, how a robot starts on it, and what
// the controller believes of it.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <fstream>

#include "hal/actuators/drive.h"
#include "sim/mujoco_backend.h"
#include "sim/springs_check.h"
#include "sim/world/description.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

constexpr double kDegree = M_PI / 180.0;

class TerrainWorldTest : public testing::Test {
 protected:
  // Load of a world of this text after `world: 1`.
  sim::WorldDescription load(const std::string& text) {
    const std::string path = testing::TempDir() + "/footfall_terrain_world.yaml";
    std::ofstream(path) << "world: 1\n" << text;
    problems = core::Diagnostics();
    return sim::load_world(path, problems);
  }
  // The only error, without the file's name.
  std::string problem_of(const std::string& text) {
    load(text);
    const std::string all = problems.to_string();
    const std::size_t name = all.find("world.yaml:");
    return name == std::string::npos ? all : all.substr(name + std::string("world.yaml:").size());
  }
  model::RobotDescription robot = load_hume();
  core::Diagnostics problems;
};

// A slope under the whole robot that rises along x, its face through (0, 0, 1 m).
constexpr const char* kSlope =
    "ground: {terrain: [{box: {at: [0 m, 0 m], size: [3 m, 3 m, 1 m], z: 1 m, pitch: -30 deg}}]}\n";

TEST_F(TerrainWorldTest, ABoxStandsOnThePlaneIfNothingElseIsSaid) {
  const auto world =
      load("ground: {terrain: [{box: {at: [2 m, 1 m], size: [1 m, 2 m, 0.5 m]}}]}\n");
  ASSERT_EQ(problems.to_string(), "");
  ASSERT_EQ(world.control_model.terrain.boxes.size(), 1u);
  const model::TerrainPiece& box = world.control_model.terrain.boxes[0];
  EXPECT_EQ(box.centre, (std::array<double, 3>{2.0, 1.0, 0.25}));
  EXPECT_EQ(box.half, (std::array<double, 3>{0.5, 1.0, 0.25}));
  EXPECT_EQ(box.R_WP, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST_F(TerrainWorldTest, ATurnedBoxKeepsTheCentreOfItsTopFace) {
  const auto world = load(
      "ground: {terrain: [{box: {at: [2 m, 1 m], size: [1 m, 2 m, 0.5 m], z: 0.8 m, "
      "roll: 20 deg, pitch: 30 deg, yaw: 40 deg}}]}\n");
  ASSERT_EQ(problems.to_string(), "");
  const model::TerrainPiece& box = world.control_model.terrain.boxes[0];
  const double cr = std::cos(20 * kDegree), sr = std::sin(20 * kDegree);
  const double cp = std::cos(30 * kDegree), sp = std::sin(30 * kDegree);
  const double cy = std::cos(40 * kDegree), sy = std::sin(40 * kDegree);
  // Third column of Rz Ry Rx: the normal of the top face.
  const std::array<double, 3> n = {cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr};
  const std::array<double, 3> top = {2.0, 1.0, 0.8};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(box.R_WP[3 * k + 2], n[k], 1e-15);
    EXPECT_NEAR(box.centre[k] + 0.25 * n[k], top[k], 1e-15);
  }
}

TEST_F(TerrainWorldTest, TheSimulatorHasItWhereTheControllerBelievesIt) {
  const auto world = load(
      "ground: {terrain: [{box: {at: [2 m, 1 m], size: [1 m, 2 m, 0.5 m], z: 0.8 m, "
      "roll: 20 deg, pitch: 30 deg, yaw: 40 deg}}]}\n");
  sim::MujocoBackend backend(robot, world);
  backend.start();
  const int geom = mj_name2id(backend.model(), mjOBJ_GEOM, "terrain_0");
  const model::TerrainPiece& box = world.control_model.terrain.boxes[0];
  for (int k = 0; k < 9; ++k) {
    EXPECT_NEAR(backend.data()->geom_xmat[9 * geom + k], box.R_WP[static_cast<std::size_t>(k)],
                1e-14);
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(backend.data()->geom_xpos[3 * geom + k], box.centre[static_cast<std::size_t>(k)],
                1e-14);
  }
}

TEST_F(TerrainWorldTest, ARobotStartsWithItsFirstBallOnTheSlope) {
  const auto world = load(kSlope);
  ASSERT_EQ(problems.to_string(), "");
  sim::MujocoBackend backend(robot, world);
  backend.start();
  double least = 1.0;
  for (const model::ContactDescription& contact : robot.contacts) {
    const int site = mj_name2id(backend.model(), mjOBJ_SITE, contact.site.c_str());
    const double* p = backend.data()->site_xpos + 3 * site;
    // Distance of the centre from the plane through (0, 0, 1) that rises by 30 deg along x.
    const double clear = -std::sin(30 * kDegree) * p[0] + std::cos(30 * kDegree) * (p[2] - 1.0);
    least = std::min(least, clear - contact.radius);
  }
  EXPECT_NEAR(least, 0.0, 1e-10);
}

TEST_F(TerrainWorldTest, FootholdsMoveAnInclinedBoxStraightUp) {
  auto world = load(kSlope);
  world.height_error = 5e-3;
  sim::MujocoBackend backend(robot, world);
  backend.start();
  for (int k = 0; k < 300; ++k) {
    backend.data()->qpos[2] += k == 0 ? 0.5 : 0.0;
    backend.write({});
  }
  const int geom = mj_name2id(backend.model(), mjOBJ_GEOM, "foothold_0_1");
  const auto& centre = world.control_model.terrain.boxes[0].centre;
  EXPECT_NE(backend.footholds()->height(0), 0.0);
  EXPECT_NEAR(backend.model()->geom_pos[3 * geom], centre[0], 1e-15);
  EXPECT_NEAR(backend.model()->geom_pos[3 * geom + 2], centre[2] + backend.footholds()->height(0),
              1e-15);
}

TEST_F(TerrainWorldTest, TheBeliefIsExactOrFlat) {
  EXPECT_EQ(load(kSlope).control_model.terrain.boxes.size(), 1u);
  EXPECT_EQ(load(std::string(kSlope) + "terrain_belief: exact\n").control_model.terrain,
            load(kSlope).control_model.terrain);
  EXPECT_TRUE(
      load(std::string(kSlope) + "terrain_belief: flat\n").control_model.terrain.boxes.empty());
}

TEST_F(TerrainWorldTest, ASeedDrawsTheDirectionOfTheBeliefsError) {
  const auto world =
      load(std::string(kSlope) + "terrain_belief: {error: {tilt: 3 deg, height: 5 mm}}\n");
  ASSERT_EQ(problems.to_string(), "");
  EXPECT_TRUE(world.variation.depends_on_seed());
  const model::TerrainPiece& truth = world.control_model.terrain.boxes[0];
  const auto top_of = [](const model::TerrainPiece& box, std::size_t k) {
    return box.centre[k] + box.R_WP[3 * k + 2] * box.half[2];
  };
  int higher = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const model::Draw drawn = model::draw(world.variation, 6, {}, seed);
    ASSERT_EQ(drawn.values.size(), 2u);
    EXPECT_EQ(drawn.values[0].first, "terrain.tilt_rad");
    EXPECT_EQ(drawn.values[1].first, "terrain.height_m");
    const auto believed = sim::with_draw(world, drawn).control_model.terrain.boxes[0];
    double trace = 0.0;  // of R'^T R
    for (std::size_t k = 0; k < 9; ++k) trace += believed.R_WP[k] * truth.R_WP[k];
    EXPECT_NEAR(std::acos(0.5 * (trace - 1.0)), 3 * kDegree, 1e-9);
    EXPECT_NEAR(top_of(believed, 0), top_of(truth, 0), 1e-15);
    const double rise = top_of(believed, 2) - top_of(truth, 2);
    EXPECT_NEAR(std::abs(rise), 5e-3, 1e-15);
    higher += rise > 0.0 ? 1 : 0;
  }
  EXPECT_GT(higher, 8);  // of 40, both signs: each of 5 sigma
  EXPECT_LT(higher, 36);
}

TEST_F(TerrainWorldTest, MalformedTerrainIsToldAtItsPlace) {
  EXPECT_EQ(
      problem_of("ground: {terrain: [{box: {at: [0 m, 0 m], size: [1 m, 1 m, 1 m], z: -2 m}}]}\n"),
      "2:69: error: the box lies below the plane z = 0, which is solid: expected a height 'z' "
      "at which it rises above that\n");
  EXPECT_EQ(problem_of("terrain_belief: {error: {tilt: 40 deg}}\n"),
            "2:32: error: expected an angle within 0.5 rad, 0 to 0.5, got '40 deg'\n");
  EXPECT_NE(problem_of("terrain_belief: flatt\n").find("did you mean"), std::string::npos);
}

// A world's actuators take the place of the robot's before anything uses them.
TEST_F(TerrainWorldTest, AWorldsSpringsAndTorqueLoopsTakeThePlaceOfTheRobots) {
  const auto world = load(
      "actuators:\n  model: series_elastic\n  stiffness: {\"*knee\": 300 Nm/rad}\n"
      "  torque_loop: {type: direct, p: 0.8, forward: 0, damps: spring, d: 11 Nm s/rad}\n");
  ASSERT_EQ(problems.to_string(), "");
  model::RobotDescription own = robot;
  sim::apply_actuators(world.actuators, own, problems);
  ASSERT_EQ(problems.to_string(), "");
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const bool knee = robot.joints[j].name.ends_with("knee");
    EXPECT_EQ(own.joints[j].spring, knee ? 300.0 : robot.joints[j].spring);
    const hal::TorqueLoopGains& gains = own.drives.torque_loop[j];
    EXPECT_EQ(gains.p, 0.8);
    EXPECT_EQ(gains.forward, 0.0);
    EXPECT_EQ(gains.damping, 11.0);
    EXPECT_EQ(gains.i, 0.0);
    EXPECT_EQ(gains.damps, hal::TorqueLoopGains::Damping::spring);
  }
  const hal::DriveSettings drives = sim::drive_settings(world.actuators, own, 2);
  EXPECT_EQ(drives.joints[2].actuator.spring, 300.0);
}

// p (tau_cmd - tau) = tau at rest: of the command 0.8/1.8 arrives.
TEST_F(TerrainWorldTest, WithoutFeedForwardAPartOfTheCommandArrives) {
  auto world = load(
      "actuators:\n  model: series_elastic\n  stiffness: 415 Nm/rad\n"
      "  torque_loop: {type: direct, p: 0.8, forward: 0, damps: spring, d: 11 Nm s/rad}\n"
      "constraints: {hoist: {body: torso, z: {stiffness: 20 kN/m, at: 3 m}}}\n");
  model::RobotDescription own = robot;
  sim::apply_actuators(world.actuators, own, problems);
  hal::SeriesElasticDrive drive(sim::drive_settings(world.actuators, own, 2));
  const std::vector<double> still(own.joints.size(), 0.0);
  std::vector<double> torques = still;
  drive.start(still, still);
  drive.command(std::vector<double>(own.joints.size(), 18.0));
  for (int k = 0; k < 3000; ++k) {
    drive.place(still);
    drive.advance(still, torques);
  }
  for (const double torque : torques) EXPECT_NEAR(torque, 8.0, 1e-3);
}

TEST_F(TerrainWorldTest, AnUnknownJointOfATorqueLoopIsToldAtItsPlace) {
  const auto world = load(
      "actuators: {model: series_elastic, torque_loop: {type: direct, p: 1, d: {\"*kne\": 11 Nm "
      "s/rad}}}\n");
  sim::apply_actuators(world.actuators, robot, problems);
  EXPECT_NE(problems.to_string().find("world.yaml:2:"), std::string::npos);
}

// In free flight gravity acts on the robot alone, and what slides has to be accelerated with it:
// the base of a rigid robot would fall with g m/(m + M); the legs bend, so that only the total
// momentum tells: m v_com + M v_base = m g t.
TEST_F(TerrainWorldTest, WhatSlidesHasInertiaAndNoWeight) {
  const auto world = load(
      "constraints: {rail: {body: torso, slides: [0 kg, 0 kg, 5 kg]}}\nstart: {height: 5 m}\n");
  ASSERT_EQ(problems.to_string(), "");
  sim::MujocoBackend backend(robot, world);
  backend.start();
  constexpr int kTicks = 150;
  for (int k = 0; k < kTicks; ++k) backend.write({});
  mj_subtreeVel(backend.model(), backend.data());
  mj_forward(backend.model(), backend.data());
  mj_subtreeVel(backend.model(), backend.data());
  const int torso = mj_name2id(backend.model(), mjOBJ_BODY, "torso");
  const double mass = backend.model()->body_subtreemass[torso];
  const double momentum =
      mass * backend.data()->subtree_linvel[3 * torso + 2] + 5.0 * backend.data()->qvel[2];
  // Semi-implicit Euler: the momentum is exact but for the change of the inertia within a step,
  // of first order in h = 1/3000 s times the rate of the legs.
  EXPECT_NEAR(momentum, -mass * 9.81 * kTicks / 1500.0, 2e-3 * mass);
}

TEST_F(TerrainWorldTest, OnlyTheFloatingBaseSlides) {
  const auto world = load("constraints: {rail: {body: right_shank, slides: [1 kg, 0 kg, 0 kg]}}\n");
  sim::check_springs(world, {}, robot, problems);
  EXPECT_NE(problems.to_string().find("error: 'slides' acts on the robot's floating base alone: "
                                      "expected 'body: torso', got 'right_shank'"),
            std::string::npos);
}

}  // namespace
}  // namespace footfall::tests
