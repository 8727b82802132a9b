// Switches, encoders, and all sensors together.
#include <gtest/gtest.h>

#include "core/realtime/allocation_count.h"
#include "hal/sensors/suite.h"
#include "tests/unit/hal/sensor_test_support.h"

namespace footfall::hal {
namespace {

SensorPlaces one_foot() {
  SensorPlaces places;
  places.contacts = 1;
  places.has_switch[0] = true;
  return places;
}

class Foot {
 public:
  explicit Foot(const SwitchErrors& errors, std::uint64_t seed = 1)
      : switches_(errors, one_foot(), kTick, seed) {
    switches_.start();
  }
  bool closed(double force) {
    switches_.sample({&force, 1}, {&closed_, 1});
    return closed_;
  }
  // Ticks from a change of the force to the report, the change's own being 0.
  int ticks_until(bool closed_now, double force) {
    int ticks = 0;
    while (closed(force) != closed_now) ++ticks;
    return ticks;
  }

 private:
  Switches switches_;
  bool closed_ = false;
};

TEST(Switches, APerfectOneClosesWithTheForce) {
  Foot foot({});
  EXPECT_FALSE(foot.closed(0.0));
  EXPECT_TRUE(foot.closed(1e-6));
  EXPECT_FALSE(foot.closed(0.0));
}

TEST(Switches, OneClosesAboveItsThreshold) {
  Foot foot({.threshold = 5.0});
  EXPECT_FALSE(foot.closed(5.0));
  EXPECT_TRUE(foot.closed(5.1));
}

// 2 ms are three ticks.
TEST(Switches, BothChangesAreReportedLate) {
  Foot foot({.delay = 2e-3});
  foot.closed(0.0);
  EXPECT_EQ(foot.ticks_until(true, 100.0), 3);
  EXPECT_EQ(foot.ticks_until(false, 0.0), 3);
}

TEST(Switches, AStandingFootIsReportedFromTheStart) {
  Foot foot({.delay = 2e-3});
  EXPECT_TRUE(foot.closed(100.0));
}

// A contact that is shorter than the delay is reported as long as it was.
TEST(Switches, AShortContactIsReportedToo) {
  Foot foot({.delay = 2e-3});
  foot.closed(0.0);
  foot.closed(100.0);
  EXPECT_EQ(foot.ticks_until(true, 0.0), 2);
  EXPECT_EQ(foot.ticks_until(false, 0.0), 0);
}

// Uniform from 0 to 1 ms, 1.5 ticks: up to a whole tick in two of three changes, else two.
TEST(Switches, JitterIsDrawnForEachChange) {
  constexpr std::size_t kChanges = 3000;
  Foot foot({.delay = 2e-3, .jitter = 1e-3});
  foot.closed(0.0);
  std::size_t four = 0;
  for (std::size_t k = 0; k < kChanges; ++k) {
    const bool down = k % 2 == 0;
    const int ticks = foot.ticks_until(down, down ? 100.0 : 0.0);
    ASSERT_TRUE(ticks == 4 || ticks == 5) << ticks;
    four += ticks == 4 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(four) / kChanges, 2.0 / 3.0,
              mean_bound(std::sqrt(2.0 / 9.0), kChanges));
}

TEST(Switches, OneBouncesOnlyAfterATouchdown) {
  Foot foot({.bounce = 10e-3});
  foot.closed(0.0);
  int open = 0;
  for (int k = 0; k < 15; ++k) open += foot.closed(100.0) ? 0 : 1;
  EXPECT_GT(open, 0);
  EXPECT_LT(open, 15);
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(foot.closed(100.0));
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(foot.closed(0.0));
}

TEST(Encoders, PositionsAreWholeCountsAndVelocitiesTheirChange) {
  constexpr double kResolution = 3.8e-4;
  Encoders encoders(kResolution, 1, kTick);
  double before = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double truth = 0.3 + 0.01 * std::sin(0.05 * k);
    double q = truth, qd = 123.0;
    encoders.sample({&q, 1}, {&qd, 1});
    EXPECT_LE(std::abs(q - truth), 0.5 * kResolution + 1e-15);
    EXPECT_NEAR(q / kResolution, std::round(q / kResolution), 1e-9);
    EXPECT_NEAR(qd, k == 0 ? 0.0 : (q - before) / kTick, 1e-9);
    before = q;
  }
}

SensorErrors all_errors() {
  return {.joint_resolution = 3.8e-4,
          .imu = {{0.01, 0.004, 1e-5}, {0.07, 0.03, 1e-4}, 0.01},
          .mocap = {480.0, 5e-3, 1e-3, 0.05, 0.1, 0.01, 1e-3},
          .switches = {5.0, 2e-3, 1e-3, 5e-3}};
}

SensorPlaces robot_places() {
  SensorPlaces places = one_foot();
  places.joints = 2;
  places.markers = 3;
  return places;
}

// A robot that sways and steps, as a backend would fill it in.
void fill(double time, SensorTruth& truth, Sensors& s) {
  s.q[0] = truth.q[0] = std::sin(time);
  s.qd[0] = truth.qd[0] = std::cos(time);
  s.p_WB = {0.1 * std::sin(3.0 * time), 0.0, 1.0};
  s.v_WB = {0.3 * std::cos(3.0 * time), 0.0, 0.0};
  s.q_WB = {1, 0, 0, 0};
  truth.normal_force[0] = std::sin(20.0 * time) > 0.0 ? 100.0 : 0.0;
}

std::vector<Sensors> measured(SensorSuite& suite, int ticks) {
  SensorTruth truth;
  Sensors s;
  fill(0.0, truth, s);
  suite.start({s.p_WB, s.q_WB, s.v_WB, s.w_WB_B});
  std::vector<Sensors> out;
  for (int k = 0; k < ticks; ++k) {
    fill(k * kTick, truth, s);
    suite.sample(truth, s);
    out.push_back(s);
  }
  return out;
}

void expect_equal(const Sensors& a, const Sensors& b) {
  for_each_field(kSensorFields,
                 [&](const auto& f) { ASSERT_EQ(a.*f.member, b.*f.member) << f.name; });
  for_each_field(kFlagFields, [&](const auto& f) { ASSERT_EQ(a.*f.member, b.*f.member) << f.doc; });
}

TEST(SensorSuite, PerfectSensorsGiveTheTruthAndTellNone) {
  SensorSuite suite({}, robot_places(), kTick, 1);
  EXPECT_FALSE(suite.has_errors());
  const std::vector<Sensors> all = measured(suite, 100);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double time = static_cast<double>(k) * kTick;
    EXPECT_EQ(all[k].q[0], std::sin(time));
    EXPECT_EQ(all[k].qd[0], std::cos(time));
    EXPECT_EQ(all[k].contact[0], std::sin(20.0 * time) > 0.0);
    EXPECT_TRUE(all[k].mocap_fresh && all[k].imu_fresh);
    EXPECT_FALSE(all[k].sensor_truth);
    EXPECT_EQ(all[k].true_q[0], 0.0);
  }
}

TEST(SensorSuite, TheTruthIsToldBesideErrors) {
  SensorSuite suite(all_errors(), robot_places(), kTick, 1);
  EXPECT_TRUE(suite.has_errors());
  const Sensors s = measured(suite, 100).back();
  EXPECT_TRUE(s.sensor_truth);
  EXPECT_EQ(s.true_q[0], std::sin(99 * kTick));
  EXPECT_NE(s.q[0], s.true_q[0]);
  EXPECT_NEAR(std::abs(s.true_gyro_bias[0]), 0.004, 1e-4);
}

TEST(SensorSuite, ASecondStartRepeatsTheFirst) {
  SensorSuite suite(all_errors(), robot_places(), kTick, 11),
      other(all_errors(), robot_places(), kTick, 12);
  const std::vector<Sensors> first = measured(suite, 300), second = measured(suite, 300);
  // What is between two runs in `Sensors` is of no account: times from the first frame on.
  for (std::size_t k = 50; k < first.size(); ++k) expect_equal(first[k], second[k]);
  EXPECT_NE(measured(other, 300).back().gyro, first.back().gyro);
}

// Each error alone: switched off, it changes nothing of the other sensors.
TEST(SensorSuite, SensorsDoNotShareRandomNumbers) {
  SensorSuite whole(all_errors(), robot_places(), kTick, 3);
  SensorErrors errors = all_errors();
  errors.mocap = {};
  errors.switches = {};
  SensorSuite imu_only(errors, robot_places(), kTick, 3);
  errors = all_errors();
  errors.imu = {};
  errors.joint_resolution = 0.0;
  SensorSuite no_imu(errors, robot_places(), kTick, 3);
  const auto all = measured(whole, 600), imu = measured(imu_only, 600),
             rest = measured(no_imu, 600);
  for (std::size_t k = 0; k < all.size(); ++k) {
    ASSERT_EQ(imu[k].gyro, all[k].gyro);
    ASSERT_EQ(imu[k].accelerometer, all[k].accelerometer);
    ASSERT_EQ(rest[k].marker, all[k].marker);
    ASSERT_EQ(rest[k].marker_seen, all[k].marker_seen);
    ASSERT_EQ(rest[k].contact, all[k].contact);
  }
}

TEST(SensorSuite, ASampleAllocatesNothing) {
  SensorSuite suite(all_errors(), robot_places(), kTick, 1);
  SensorTruth truth;
  Sensors s;
  suite.start({});
  core::arm_allocation_count(true);
  const std::int64_t before = core::allocation_count();
  for (int k = 0; k < 3000; ++k) {
    fill(k * kTick, truth, s);
    suite.sample(truth, s);
  }
  core::arm_allocation_count(false);
  EXPECT_EQ(core::allocation_count(), before);
}

}  // namespace
}  // namespace footfall::hal
