// Ages, the clock, and values that are not finite.
#include <limits>

#include "engine/tick/safety.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/fake_robot.h"
#include "tests/unit/engine/watch/watch_test_support.h"

namespace footfall::tests {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class SensorWatchTest : public WatchTest {};

TEST_F(SensorWatchTest, DataThatAreNotNewAreStaleBeyondTheLimitForEveryEstimator) {
  for (const auto type :
       {EstimatorType::true_state, EstimatorType::motion_capture, EstimatorType::contact_kalman}) {
    watch(type);
    tick();
    EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, [](hal::Sensors& s) { s.imu_fresh = false; }),
              6);  // 5 ms are allowed
    EXPECT_EQ(
        ticks_until(&SensorFindings::mocap_stale, [](hal::Sensors& s) { s.mocap_fresh = false; }),
        11);
    tick();  // in which the estimator uses a frame again
    const SensorFindings after = tick();
    EXPECT_FALSE(after.imu_stale || after.mocap_stale || after.clock || after.infinite);
  }
}

TEST_F(SensorWatchTest, FramesMayComeAtALowerRateThanTicks) {
  watch(EstimatorType::motion_capture);
  for (int k = 0; k < 100; ++k) {
    EXPECT_FALSE(tick([&](hal::Sensors& s) { s.mocap_fresh = k % 4 == 0; }).mocap_stale);
  }
}

// Too old for it, say.
TEST_F(SensorWatchTest, FramesThatTheEstimatorDoesNotUseAreStale) {
  watch(EstimatorType::motion_capture);
  used_ = 0;
  EXPECT_EQ(ticks_until(&SensorFindings::mocap_stale, nullptr), 11);
}

TEST_F(SensorWatchTest, AReadThatBringsNothingGivesNothingNew) {
  watch(EstimatorType::contact_kalman);
  tick();
  EXPECT_TRUE(watch_->joints_new());
  for (int k = 0; k < 3; ++k) {
    tick(nullptr, false);
    const hal::Sensors& given = watch_->usable();
    EXPECT_FALSE(given.imu_fresh || given.mocap_fresh || watch_->joints_new());
    EXPECT_EQ(given.q[0], 2e-3);  // of the first of these reads
  }
  tick([](hal::Sensors& s) { s.qd[1] = kNan; });
  EXPECT_FALSE(watch_->joints_new());
  EXPECT_TRUE(watch_->usable().imu_fresh);
  tick([](hal::Sensors& s) { s.qd[1] = 0.0; });
  EXPECT_TRUE(watch_->joints_new());
  EXPECT_EQ(&watch_->usable(), &sensors_);
}

TEST_F(SensorWatchTest, AReadThatBringsNothingAgesWhatWasThere) {
  watch(EstimatorType::motion_capture);
  tick(), tick();
  for (int k = 1; k <= 20; ++k) {
    const SensorFindings found = tick(nullptr, false);
    EXPECT_EQ(found.imu_stale, k > 5);
    EXPECT_EQ(found.mocap_stale, k > 10);
    EXPECT_FALSE(found.clock);
  }
}

TEST_F(SensorWatchTest, TheClockMayNeitherGoBackNorStandStillNorJump) {
  watch(EstimatorType::true_state);
  EXPECT_FALSE(tick().clock);
  EXPECT_FALSE(tick().clock);
  EXPECT_TRUE(tick([](hal::Sensors& s) { s.time_ns -= 1'000'000; }).clock);  // stands still
  EXPECT_FALSE(tick([](hal::Sensors& s) { s.time_ns -= 500'000; }).clock);
  EXPECT_TRUE(tick([](hal::Sensors& s) { s.time_ns -= 3'000'000; }).clock);  // goes back
  EXPECT_FALSE(tick().clock);
  EXPECT_FALSE(tick([](hal::Sensors& s) { s.time_ns += 9'000'000; }).clock);
  tick_ += 20;
  EXPECT_TRUE(tick().clock);
}

TEST_F(SensorWatchTest, AClockGoesOnWhileReadsBringNothing) {
  watch(EstimatorType::true_state);
  tick(), tick();
  for (int k = 0; k < 50; ++k) tick(nullptr, false);
  EXPECT_FALSE(tick().clock);
}

TEST_F(SensorWatchTest, ABackendWithoutAClockHasNoFault) {
  watch(EstimatorType::true_state);
  EXPECT_EQ(ticks_until(&SensorFindings::clock, [](hal::Sensors& s) { s.time_ns = 0; }), -1);
}

TEST_F(SensorWatchTest, AnEstimatorGetsTheLastGoodValueInsteadOfOneThatIsNotFinite) {
  watch(EstimatorType::motion_capture);
  tick([](hal::Sensors& s) { s.q[1] = 0.25; });
  const hal::Sensors good = sensors_;
  const SensorFindings found = tick([](hal::Sensors& s) {
    s.q[1] = std::numeric_limits<double>::infinity();
    s.gyro[2] = kNan;
    s.marker[1][0] = kNan;
  });
  EXPECT_TRUE(found.infinite);
  const hal::Sensors& given = watch_->usable();
  EXPECT_EQ(given.q[1], 0.25);
  EXPECT_EQ(given.gyro, good.gyro);
  EXPECT_FALSE(given.imu_fresh);
  EXPECT_FALSE(given.marker_seen[1]);
  EXPECT_TRUE(given.marker_seen[0] && given.mocap_fresh);
  EXPECT_EQ(given.marker[0], sensors_.marker[0]);
  EXPECT_FALSE(tick().infinite);
  EXPECT_EQ(&watch_->usable(), &sensors_);
}

// Torques and motors give the joints' positions, whatever tells the contacts.
TEST_F(SensorWatchTest, AnEstimatorThatMeasuresUsesTorquesAndMotors) {
  for (const auto field : {&hal::Sensors::tau, &hal::Sensors::motor}) {
    for (const auto contact :
         {behaviors::ContactSource::switches, behaviors::ContactSource::torque}) {
      watch(EstimatorType::contact_kalman, contact);
      tick([&](hal::Sensors& s) { (s.*field)[0] = 0.5; });
      EXPECT_TRUE(tick([&](hal::Sensors& s) { (s.*field)[0] = kNan; }).infinite);
      EXPECT_EQ((watch_->usable().*field)[0], 0.5);
      (sensors_.*field)[0] = 0.0;
    }
  }
}

TEST_F(SensorWatchTest, WhatTheEstimatorDoesNotUseMayBeAnything) {
  watch(EstimatorType::contact_kalman);
  EXPECT_FALSE(tick([](hal::Sensors& s) {
                 s.marker[0][1] = s.motor_torque[0] = kNan;
                 s.q[core::kMaxJoints - 1] = kNan;  // of no joint
               }).infinite);
  watch(EstimatorType::true_state);
  EXPECT_FALSE(tick([](hal::Sensors& s) { s.gyro[0] = s.tau[0] = s.motor[0] = kNan; }).infinite);
}

TEST_F(SensorWatchTest, GoesOnFromAnotherWatch) {
  const auto stale = [](hal::Sensors& s) { s.imu_fresh = false; };
  watch(EstimatorType::true_state);
  tick();
  for (int k = 0; k < 4; ++k) tick(stale);
  const SensorWatch old = *watch_;
  watch(EstimatorType::contact_kalman);
  watch_->take_over(old);
  EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, stale), 2);  // 4 and 2 ms are beyond 5 ms
}

TEST_F(SensorWatchTest, AllocatesNothing) {
  watch(EstimatorType::motion_capture);
  tick();
  const AllocationGuard guard;
  tick();
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(SensorWatchFaults, EachFindingIsAFault) {
  const auto behavior = load_inline(
      "behavior: 1\nrobot: hume\nmachine: {tasks: {rest: {type: joint_damping, priority: 1, gains: "
      "{kd: 5}}}}\n");
  const model::ControlModel model(behavior->robot);
  engine::SafetyFilter filter(behavior->robot);
  engine::TickStart tick;
  EXPECT_FALSE(filter.check_state({}, tick, model).has(core::Fault::sensor_nan));
  EXPECT_FALSE(filter.check_state({}, tick, model).has(core::Fault::sensor_stale));
  tick.sensed = {.imu_stale = true,
                 .mocap_stale = true,
                 .joints_stale = true,
                 .clock = true,
                 .infinite = true};
  const engine::FaultFindings found = filter.check_state({}, tick, model);
  for (const auto fault :
       {core::Fault::imu_stale, core::Fault::mocap_stale, core::Fault::sensor_stale,
        core::Fault::sensor_clock, core::Fault::sensor_nan}) {
    EXPECT_TRUE(found.has(fault));
  }
}

}  // namespace
}  // namespace footfall::tests
