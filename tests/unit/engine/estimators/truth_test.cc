// The truth beside the estimate, and its signals.
#include "engine/estimators/truth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "tests/support/fake_robot.h"

namespace footfall::tests {
namespace {

constexpr const char* kEstimated = R"(
behavior: 1
robot: hume
estimator: {type: contact_kalman}
machine:
  tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}
)";

// The signals of an estimator, while the state is the true one.
void with_true_state(behaviors::Behavior& behavior) {
  behavior.estimator.type = behaviors::EstimatorType::true_state;
  behavior.estimator.slots = 0;
}

TEST(Truth, AnglesAreThoseOfTheQuaternionsRotation) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-1.4, 1.4);
  for (int k = 0; k < 100; ++k) {
    const double roll = angle(random), pitch = angle(random), yaw = 2.0 * angle(random);
    const Eigen::Quaterniond q(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
    const auto rpy = engine::rpy_of({q.w(), q.x(), q.y(), q.z()});
    EXPECT_NEAR(rpy[0], roll, 1e-12);
    EXPECT_NEAR(rpy[1], pitch, 1e-12);
    EXPECT_NEAR(rpy[2], yaw, 1e-12);
  }
}

// With joints as they are, the CoM of the true base is that of a model updated with it.
TEST(Truth, TheCoMMovesWithTheTrueBase) {
  const auto behavior = load_inline(kEstimated);
  const model::RobotDescription& robot = behavior->robot;
  model::State estimate;
  for (int j = 0; j < robot.joint_count(); ++j) {
    estimate.q[static_cast<std::size_t>(j)] = robot.joints[static_cast<std::size_t>(j)].posture;
  }
  estimate.p_WB = {0.1, -0.2, 0.9};
  model::State actual = estimate;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -3.0).normalized()));
  actual.q_WB = {q.w(), q.x(), q.y(), q.z()};
  actual.p_WB = {1.0, 2.0, 3.0};
  model::ControlModel model(robot), oracle(robot);
  model.update(estimate);
  oracle.update(actual);
  hal::Sensors sensors;
  sensors.has_truth = true;
  sensors.p_WB = actual.p_WB;
  sensors.q_WB = actual.q_WB;
  const engine::Truth truth = engine::truth_of(sensors, model);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(truth.com[k], oracle.com().position[k], 1e-12);
    EXPECT_NEAR(truth.rpy[k], oracle.rpy()[k], 1e-12);
  }
  sensors.sensor_truth = true;
  sensors.true_com = {7.0, 8.0, 9.0};
  EXPECT_EQ(engine::truth_of(sensors, model).com, sensors.true_com);
}

double signal(const StubRig& rig, const char* name) {
  const int index = rig.loop->signals().find(name);
  return index < 0 ? -1.0 : rig.loop->signals().values()[index];
}

TEST(Truth, IsASignalBesideTheEstimateWhereTheBackendTellsIt) {
  StubRig rig(kEstimated, 1.0, nullptr, with_true_state);
  bool tells = true;
  rig.hardware->spoil = [&](hal::Sensors& s, std::int64_t) {
    s.has_truth = tells;
    s.sensor_truth = tells;
    s.true_gyro_bias = {1e-3, 2e-3, 3e-3};
    s.p_WB[0] = 0.5;
  };
  rig.loop->start();
  rig.loop->tick();
  EXPECT_EQ(signal(rig, "truth.base.pos.x"), 0.5);
  EXPECT_EQ(signal(rig, "truth.gyro_bias.y"), 2e-3);
  EXPECT_EQ(signal(rig, "estimate.markers"), 0.0);
  tells = false;
  rig.loop->tick();
  for (const char* name : {"truth.base.pos.x", "truth.com.pos.z", "truth.base.rpy.yaw",
                           "truth.base.vel.x", "truth.gyro_bias.y"}) {
    EXPECT_TRUE(std::isnan(signal(rig, name))) << name;
  }
}

TEST(Truth, HasNoSignalsOfItsOwnWhereTheStateIsTheTruth) {
  const auto behavior = load_inline(
      "behavior: 1\nrobot: hume\nmachine: {tasks: {rest: {type: joint_damping, priority: 1, gains: "
      "{kd: 5}}}}\n");
  EXPECT_EQ(behavior->signals.find("truth.com.pos.x"), -1);
  EXPECT_EQ(behavior->signals.find("estimate.markers"), -1);
}

}  // namespace
}  // namespace footfall::tests
