// The IMU against motions whose mean rates and forces are known, and its errors against their
// statistics.
#include "hal/sensors/imu.h"

#include <gtest/gtest.h>

#include "hal/sensors/rotation.h"
#include "tests/unit/hal/sensor_test_support.h"

namespace footfall::hal {
namespace {

Quaternion turn_about(const Vector3& axis, double angle) {
  const double s = std::sin(0.5 * angle);
  return {std::cos(0.5 * angle), s * axis[0], s * axis[1], s * axis[2]};
}

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

struct Sample {
  Vector3 gyro{}, accelerometer{};
};

Sample sample(Imu& imu, const BaseMotion& motion) {
  Sample out;
  imu.sample(motion, out.gyro, out.accelerometer);
  return out;
}

// What is measured at rest, `count` times, of a gyro or an accelerometer less gravity.
std::vector<Sample> at_rest(const ImuErrors& errors, std::uint64_t seed, std::size_t count) {
  Imu imu(errors, {.gravity = {0.0, 0.0, 0.0}}, kTick, seed);
  imu.start({});
  std::vector<Sample> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back(sample(imu, {}));
  return out;
}

TEST(Imu, AtRestItFeelsTheGroundPushUp) {
  const BaseMotion tilted = {.q_WB = turn_about({1, 0, 0}, 0.3)};
  Imu imu({}, {}, kTick, 1);
  imu.start(tilted);
  const Sample s = sample(imu, tilted);
  EXPECT_EQ(s.gyro, (Vector3{0, 0, 0}));
  EXPECT_NEAR(s.accelerometer[0], 0.0, 1e-14);
  EXPECT_NEAR(s.accelerometer[1], 9.81 * std::sin(0.3), 1e-14);
  EXPECT_NEAR(s.accelerometer[2], 9.81 * std::cos(0.3), 1e-14);
}

// In free fall nothing is felt: v(t) = v0 + g t.
TEST(Imu, InFreeFallItFeelsNothing) {
  BaseMotion motion = {.v_WB = {1, 2, 3}};
  Imu imu({}, {}, kTick, 1);
  imu.start(motion);
  sample(imu, motion);
  motion.v_WB[2] -= 9.81 * kTick;
  for (const double x : sample(imu, motion).accelerometer) EXPECT_NEAR(x, 0.0, 1e-11);
}

// R(t) = R(t-T) exp(gyro T), for turns in changing directions and both signs of the quaternion.
TEST(Imu, TheGyroGivesTheRotationOfTheTick) {
  const std::vector<Vector3> rates = {{1, 2, -3}, {-4, 0.5, 2}, {0, 0, 0}, {30, -20, 10}};
  BaseMotion motion = {.q_WB = turn_about({0, 1, 0}, 1.2)};
  Imu imu({}, {}, kTick, 1);
  imu.start(motion);
  sample(imu, motion);
  for (const Vector3& w : rates) {
    const double speed = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const double scale = speed > 0.0 ? 1.0 / speed : 0.0;
    motion.q_WB =
        product(motion.q_WB, turn_about({scale * w[0], scale * w[1], scale * w[2]}, speed * kTick));
    for (double& x : motion.q_WB) x = -x;
    const Sample s = sample(imu, motion);
    // 1e-16 of a quaternion's round-off, doubled and divided by the tick.
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(s.gyro[k], w[k], 1e-12 + 1e-14 * speed);
  }
}

// On an arm r that turns with w about z: between two ticks the IMU's velocity w r turns by w T, so
// its change is 2 w r sin(w T / 2), inwards along the arm of the middle of the tick.
TEST(Imu, OnATurningArmItFeelsTheCentripetalForce) {
  constexpr double kRate = 5.0, kArm = 0.2;
  Imu imu({}, {.p_BI = {kArm, 0, 0}, .gravity = {0, 0, 0}}, kTick, 1);
  const auto at = [](double time) {
    return BaseMotion{.q_WB = turn_about({0, 0, 1}, kRate * time), .w_WB_B = {0, 0, kRate}};
  };
  imu.start(at(0.0));
  sample(imu, at(0.0));
  const Sample s = sample(imu, at(kTick));
  EXPECT_NEAR(s.accelerometer[0], -2.0 * kRate * kArm * std::sin(0.5 * kRate * kTick) / kTick,
              1e-11);
  EXPECT_NEAR(s.accelerometer[1], 0.0, 1e-11);
  EXPECT_NEAR(s.gyro[2], kRate, 1e-11);
}

TEST(Imu, ItsAxesAreThoseOfItsSite) {
  // The IMU's x is the base's z: columns are the IMU's axes in the base.
  const Matrix3 R_BI = {0, 1, 0, 0, 0, 1, 1, 0, 0};
  const BaseMotion turning = {.w_WB_B = {0.1, 0.2, 0.3}};
  Imu imu({}, {.R_BI = R_BI}, kTick, 1);
  imu.start(turning);
  const Sample s = sample(imu, turning);
  EXPECT_EQ(s.gyro, (Vector3{0.3, 0.1, 0.2}));
  EXPECT_EQ(s.accelerometer, (Vector3{9.81, 0, 0}));
}

// White noise: the Allan variance falls as one over the number of samples in a mean.
TEST(Imu, WhiteNoiseAveragesOut) {
  constexpr std::size_t kSamples = 120'000;
  const std::vector<Sample> samples =
      at_rest({.gyro = {.noise = 0.01}, .accelerometer = {.noise = 0.07}}, 3, kSamples);
  std::vector<double> gyro, accelerometer;
  for (const Sample& s : samples) {
    gyro.push_back(s.gyro[1]);
    accelerometer.push_back(s.accelerometer[2]);
  }
  for (const std::size_t m : {1, 10, 100}) {
    const auto inverse = 1.0 / static_cast<double>(m);
    // Adjacent differences share a mean: the estimate's relative deviation is sqrt(3 / clusters).
    const double bound = kSigmas * std::sqrt(3.0 * static_cast<double>(m) / kSamples) * inverse;
    EXPECT_NEAR(allan_variance(gyro, m), 1e-4 * inverse, 1e-4 * bound) << m;
    EXPECT_NEAR(allan_variance(accelerometer, m), 4.9e-3 * inverse, 4.9e-3 * bound) << m;
  }
}

TEST(Imu, BiasesHaveTheirMagnitudeAndASignOfTheSeed) {
  double signs = 0.0;
  constexpr std::uint64_t kSeeds = 400;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ImuErrors errors = {.gyro = {.bias = 0.004}, .accelerometer = {.bias = 0.03}};
    const Sample s = at_rest(errors, seed, 1).front();
    for (const double x : s.gyro) {
      ASSERT_NEAR(std::abs(x), 0.004, 0.5 * kDigit);
      signs += x > 0.0 ? 1.0 : -1.0;
    }
    for (const double x : s.accelerometer) ASSERT_NEAR(std::abs(x), 0.03, 0.5 * kDigit);
  }
  EXPECT_NEAR(signs / (3.0 * kSeeds), 0.0, mean_bound(1.0, 3 * kSeeds));
}

TEST(Imu, TheTruthOfABiasIsWhatIsMeasuredBesideTheMotion) {
  Imu imu({.gyro = {.bias = 0.004, .walk = 0.1}}, {}, kTick, 5);
  imu.start({});
  Sample first = sample(imu, {}), last;
  for (int k = 0; k < 1500; ++k) {
    last = sample(imu, {});
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_NEAR(last.gyro[i], imu.gyro_bias()[i], 0.5 * kDigit);
    }
  }
  EXPECT_NE(first.gyro, last.gyro);
}

TEST(Imu, WithoutItsNoiseTheGyroLeavesTheAccelerometerAsItIs) {
  const InertialErrors accelerometer = {.noise = 0.07, .bias = 0.03, .walk = 0.01};
  const auto with = at_rest({{.noise = 0.01, .bias = 0.1, .walk = 0.1}, accelerometer, 0.0}, 9, 99);
  const auto without = at_rest({{}, accelerometer, 0.0}, 9, 99);
  for (std::size_t k = 0; k < with.size(); ++k) {
    ASSERT_EQ(with[k].accelerometer, without[k].accelerometer) << k;
  }
}

// A small turn v of the mount moves gravity by g (v_y, -v_x) in its x and y.
TEST(Imu, AMountErrorTurnsItsAxes) {
  std::vector<double> turns;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Imu imu({.mount = 0.01}, {}, kTick, seed);
    imu.start({});
    const Sample s = sample(imu, {});
    turns.push_back(s.accelerometer[0] / 9.81);
    turns.push_back(s.accelerometer[1] / 9.81);
  }
  // Products of two of the turns, 1e-4, are the error of the small turn: relative 1e-2.
  EXPECT_NEAR(variance_of(turns), 1e-4, variance_bound(1e-4, turns.size()) + 1e-6);
}

}  // namespace
}  // namespace footfall::hal
