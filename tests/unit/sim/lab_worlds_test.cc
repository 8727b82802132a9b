// The worlds `lab` and `lab_mild` are what experiments say they are.
#include <gtest/gtest.h>

#include <numbers>

#include "sim/world/description.h"

namespace footfall::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

WorldDescription load(const std::string& name) {
  core::Diagnostics diagnostics;
  const auto world = load_world(FOOTFALL_SOURCE_DIR "/sim/worlds/" + name + ".yaml", diagnostics);
  check_supported(world, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  return world;
}

// The torque loops, springs and delays of `sea`.
void expect_actuators_of_sea(const WorldDescription& world) {
  const WorldDescription sea = load("sea");
  EXPECT_EQ(world.actuators.model, ActuatorModel::series_elastic);
  EXPECT_EQ(world.actuators.command_delay, sea.actuators.command_delay);
  EXPECT_EQ(world.actuators.viscous, sea.actuators.viscous);
  EXPECT_EQ(world.actuators.coulomb, sea.actuators.coulomb);
  EXPECT_EQ(world.actuators.motor_resolution, sea.actuators.motor_resolution);
  EXPECT_EQ(world.actuators.deflection_resolution, sea.actuators.deflection_resolution);
  EXPECT_EQ(world.variation.spring.b, sea.variation.spring.b);
  EXPECT_EQ(world.variation.coulomb.b, sea.variation.coulomb.b);
  EXPECT_EQ(world.variation.joints.a, sea.variation.joints.a);
}

TEST(LabWorlds, LabHasTheErrorsOfTheRobotsParts) {
  const WorldDescription world = load("lab");
  expect_actuators_of_sea(world);
  const hal::SensorErrors& e = world.sensors.errors;
  EXPECT_EQ(e.joint_resolution, 3.8e-4);
  EXPECT_EQ(e.imu.gyro.noise, 0.01);
  EXPECT_DOUBLE_EQ(e.imu.gyro.bias, 0.25 * kDegree);
  EXPECT_EQ(e.imu.gyro.walk, 1e-5);
  EXPECT_EQ(e.imu.accelerometer.noise, 0.07);
  EXPECT_EQ(e.imu.accelerometer.bias, 0.03);
  EXPECT_EQ(e.imu.accelerometer.walk, 1e-4);
  EXPECT_EQ(e.imu.mount, 0.0);
  EXPECT_EQ(e.mocap.rate, 480.0);
  EXPECT_DOUBLE_EQ(e.mocap.delay, 5e-3);
  EXPECT_DOUBLE_EQ(e.mocap.noise, 1e-3);
  EXPECT_DOUBLE_EQ(e.mocap.occlusion, 0.05);
  EXPECT_DOUBLE_EQ(e.mocap.spell, 0.1);
  EXPECT_DOUBLE_EQ(e.mocap.dropped, 0.01);
  EXPECT_DOUBLE_EQ(e.mocap.placement, 1e-3);
  EXPECT_DOUBLE_EQ(e.switches.delay, 2e-3);
  EXPECT_DOUBLE_EQ(e.switches.jitter, 1e-3);
  EXPECT_EQ(e.switches.threshold, 5.0);
  EXPECT_EQ(e.switches.bounce, 0.0);
  EXPECT_EQ(world.friction, 0.7);
  EXPECT_EQ(world.variation.friction.kind, model::Spread::Kind::none);
  EXPECT_DOUBLE_EQ(world.height_error, 5e-3);
  EXPECT_EQ(world.variation.mass.kind, model::Spread::Kind::sign);
  EXPECT_DOUBLE_EQ(world.variation.mass.a, 0.05);
  ASSERT_EQ(world.variation.com.size(), 1u);
  EXPECT_EQ(world.variation.com.at("torso").kind, model::Spread::Kind::ring);
  EXPECT_DOUBLE_EQ(world.variation.com.at("torso").a, 0.01);
  EXPECT_TRUE(world.constraints.empty());
  EXPECT_TRUE(world.variation.depends_on_seed());
}

TEST(LabWorlds, LabMildHasHalfTheNoiseAndAnExactModel) {
  const WorldDescription lab = load("lab"), mild = load("lab_mild");
  expect_actuators_of_sea(mild);
  const hal::SensorErrors &e = mild.sensors.errors, &whole = lab.sensors.errors;
  EXPECT_DOUBLE_EQ(e.imu.gyro.noise, 0.5 * whole.imu.gyro.noise);
  EXPECT_DOUBLE_EQ(e.imu.gyro.bias, 0.5 * whole.imu.gyro.bias);
  EXPECT_DOUBLE_EQ(e.imu.accelerometer.noise, 0.5 * whole.imu.accelerometer.noise);
  EXPECT_DOUBLE_EQ(e.imu.accelerometer.bias, 0.5 * whole.imu.accelerometer.bias);
  EXPECT_DOUBLE_EQ(e.mocap.noise, 0.5 * whole.mocap.noise);
  EXPECT_DOUBLE_EQ(e.mocap.placement, 0.5 * whole.mocap.placement);
  EXPECT_DOUBLE_EQ(e.mocap.occlusion, 0.5 * whole.mocap.occlusion);
  EXPECT_DOUBLE_EQ(mild.height_error, 0.5 * lab.height_error);
  EXPECT_EQ(mild.variation.mass.kind, model::Spread::Kind::none);
  EXPECT_TRUE(mild.variation.com.empty());
  EXPECT_EQ(mild.control_model.mass_scale, 1.0);
  // All else is that of `lab`.
  EXPECT_EQ(e.joint_resolution, whole.joint_resolution);
  EXPECT_EQ(e.mocap.rate, whole.mocap.rate);
  EXPECT_EQ(e.mocap.delay, whole.mocap.delay);
  EXPECT_EQ(e.mocap.spell, whole.mocap.spell);
  EXPECT_EQ(e.mocap.dropped, whole.mocap.dropped);
  EXPECT_EQ(e.switches.delay, whole.switches.delay);
  EXPECT_EQ(e.switches.jitter, whole.switches.jitter);
  EXPECT_EQ(e.switches.threshold, whole.switches.threshold);
  EXPECT_EQ(mild.friction, lab.friction);
}

}  // namespace
}  // namespace footfall::sim
