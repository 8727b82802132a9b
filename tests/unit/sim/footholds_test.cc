// Ground that has another height for every step of a foot.
#include "sim/footholds.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "sim/mujoco_backend.h"
#include "sim/scene.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

constexpr double kError = 5e-3;  // m

class FootholdsTest : public testing::Test {
 protected:
  FootholdsTest() {
    world.height_error = kError;
    world.noise_seed = 3;
  }
  void start() {
    backend = std::make_unique<sim::MujocoBackend>(robot, world);
    backend->start();
    standing = backend->data()->qpos[2];
  }
  // Puts the robot at rest with its feet `height` above the nominal ground, and ticks.
  hal::Sensors put(double height, double x = 0.0) {
    mjData* d = backend->data();
    d->qpos[0] = x;
    d->qpos[2] = standing + height;
    for (int k = 3; k < 7; ++k) d->qpos[k] = k == 3 ? 1.0 : 0.0;
    for (int k = 0; k < backend->model()->nv; ++k) d->qvel[k] = 0.0;
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const int joint = mj_name2id(backend->model(), mjOBJ_JOINT, robot.joints[j].name.c_str());
      d->qpos[backend->model()->jnt_qposadr[joint]] = robot.joints[j].posture;
    }
    backend->write({});
    hal::Sensors sensors;
    backend->read(sensors);
    return sensors;
  }
  double height(int contact) const { return backend->footholds()->height(contact); }

  model::RobotDescription robot = load_hume();
  sim::WorldDescription world;
  std::unique_ptr<sim::MujocoBackend> backend;
  double standing = 0.0;
};

TEST_F(FootholdsTest, WithoutAnErrorTheSceneHasOneGround) {
  EXPECT_NE(sim::scene_xml(robot, world).find("foothold_1_0"), std::string::npos);
  world.height_error = 0.0;
  EXPECT_EQ(sim::scene_xml(robot, world).find("foothold"), std::string::npos);
  EXPECT_EQ(sim::MujocoBackend(robot, world).footholds(), nullptr);
}

TEST_F(FootholdsTest, AtTheStartTheGroundIsLevel) {
  start();
  EXPECT_EQ(height(0), 0.0);
  EXPECT_EQ(height(1), 0.0);
  const hal::Sensors standing_still = put(-1e-4);
  EXPECT_TRUE(standing_still.contact[0] && standing_still.contact[1]);
}

// Uniform: the mean is 0, the variance e^2 / 3, its estimate's deviation sqrt(4 / 45 / n) e^2.
TEST_F(FootholdsTest, HeightsAreUniformAndChangeInTheAirOnly) {
  constexpr int kSteps = 400;
  start();
  double sum = 0.0, squares = 0.0, products = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    put(0.1);
    const double left = height(0), right = height(1);
    ASSERT_LE(std::abs(left), kError);
    put(0.2);  // the same swing
    put(2.5 * kError);
    ASSERT_EQ(height(0), left);
    put(-2.0 * kError);  // both feet touch
    ASSERT_EQ(height(0), left);
    put(0.5 * kError);  // not clear
    ASSERT_EQ(height(0), left);
    ASSERT_EQ(backend->footholds()->drawn(), 2 * (step + 1));  // one a foot
    sum += left;
    squares += left * left;
    products += left * right;
  }
  EXPECT_NEAR(sum / kSteps, 0.0, 5.0 * kError / std::sqrt(3.0 * kSteps));
  EXPECT_NEAR(squares / kSteps, kError * kError / 3.0,
              5.0 * kError * kError * std::sqrt(4.0 / 45.0 / kSteps));
  EXPECT_NEAR(products / kSteps, 0.0, 5.0 * kError * kError / (3.0 * std::sqrt(kSteps)));
}

// A foot on the nominal ground touches where its own ground is higher, and not where it is lower.
TEST_F(FootholdsTest, EachFootMeetsItsOwnGround) {
  start();
  int touching = 0, free = 0;
  for (int step = 0; step < 40; ++step) {
    put(0.1);
    const hal::Sensors s = put(0.0);
    for (int c = 0; c < 2; ++c) {
      if (std::abs(height(c)) < 1e-4) continue;
      EXPECT_EQ(s.contact[static_cast<std::size_t>(c)], height(c) > 0.0) << height(c);
      ++(height(c) > 0.0 ? touching : free);
    }
    put(-2.0 * kError);
  }
  EXPECT_GT(touching, 10);
  EXPECT_GT(free, 10);
}

// The rest of the robot meets the level ground, as without errors.
TEST_F(FootholdsTest, OtherBodiesMeetTheCommonGround) {
  start();
  EXPECT_FALSE(put(0.0).body_contact);
  EXPECT_TRUE(put(-1.0).body_contact);
}

// On a box of 7 cm the feet touch at its height plus their errors.
TEST_F(FootholdsTest, TerrainMovesWithTheGround) {
  sim::TerrainBox box;
  box.at = {2.0, 0.0};
  box.size = {1.0, 2.0, 0.07};
  world.terrain.push_back(box);
  start();
  int touching = 0, free = 0;
  for (int step = 0; step < 40; ++step) {
    put(0.2, 2.0);
    const double left = height(0);
    const hal::Sensors s = put(0.07, 2.0);
    EXPECT_EQ(height(0), left);
    if (std::abs(left) > 1e-4) {
      EXPECT_EQ(s.contact[0], left > 0.0) << left;
      ++(left > 0.0 ? touching : free);
    }
    put(0.07 - 2.0 * kError, 2.0);
    EXPECT_EQ(height(0), left);
  }
  EXPECT_GT(touching, 5);
  EXPECT_GT(free, 5);
}

}  // namespace
}  // namespace footfall::tests
