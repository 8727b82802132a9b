// Ages, frozen sensors, the clock, and values that are not finite.
#include "engine/watch/sensor_watch.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <optional>

#include "engine/tick/safety.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/fake_robot.h"

namespace footfall::tests {
namespace {

using behaviors::EstimatorType;
using engine::SensorFindings;
using engine::SensorWatch;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A watch on a robot of 1 kHz whose IMU and motion capture move in every tick.
class SensorWatchTest : public testing::Test {
 protected:
  SensorWatchTest() {
    robot_.rate_mhz = 1'000'000;
    robot_.imu_age = 5e-3;
    robot_.mocap_age = 10e-3;
    robot_.joints.resize(2);
  }
  void watch(EstimatorType type,
             behaviors::ContactSource contact = behaviors::ContactSource::switches) {
    watch_.emplace(behaviors::EstimatorSpec{.type = type, .contact = contact}, robot_);
  }
  SensorFindings tick(const std::function<void(hal::Sensors&)>& change = nullptr,
                      bool fresh = true) {
    ++tick_;
    const auto t = static_cast<double>(tick_);
    sensors_.time_ns = tick_ * 1'000'000;
    sensors_.gyro = {t, 0.0, 0.0};
    sensors_.accelerometer = {0.0, 0.0, 9.81 + 1e-3 * t};
    for (std::size_t m = 0; m < 4; ++m) {
      sensors_.marker[m] = {t, 0.1 * static_cast<double>(m), 1.0};
      sensors_.marker_seen[m] = true;
    }
    sensors_.imu_fresh = sensors_.mocap_fresh = true;
    sensors_.q = {1e-3 * t, 0.0};
    if (change) change(sensors_);
    const SensorFindings found = watch_->check(sensors_, fresh);
    watch_->used(used_);
    commands_.tau[0] += driven_ ? 1.0 : 0.0;
    watch_->commanded(commands_);
    return found;
  }
  // Ticks with this change until the finding, at most 100.
  int ticks_until(bool SensorFindings::*finding, const std::function<void(hal::Sensors&)>& change) {
    for (int k = 1; k <= 100; ++k) {
      if (tick(change).*finding) return k;
    }
    return -1;
  }

  model::RobotDescription robot_;
  std::optional<SensorWatch> watch_;
  hal::Sensors sensors_;
  std::int64_t tick_ = 0;
  int used_ = 4;  // markers by the estimator
  hal::Commands commands_;
  bool driven_ = true;  // commands change in every tick
};

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

TEST_F(SensorWatchTest, AFrozenImuIsStaleWhereItIsNeeded) {
  const auto freeze = [](hal::Sensors& s) {
    s.gyro = {1.0, 0.0, 0.0};
    s.accelerometer = {0.0, 0.0, 9.81};
  };
  watch(EstimatorType::motion_capture);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, freeze), 7);  // the first one differs
  watch(EstimatorType::true_state);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, freeze), -1);
}

// Perfect ones of a simulator at rest never change; a real one that does not is dead.
TEST_F(SensorWatchTest, AnImuThatHasNeverMovedIsFrozenUnlessItIsPerfect) {
  const auto rest = [](hal::Sensors& s) {
    s.gyro = {};
    s.accelerometer = {0.0, 0.0, 9.81};
  };
  watch(EstimatorType::contact_kalman);
  sensors_.has_truth = true;
  EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, rest), -1);
  sensors_.sensor_truth = true;
  watch(EstimatorType::contact_kalman);
  EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, rest), 7);  // the first one is new
  sensors_.has_truth = sensors_.sensor_truth = false;
  watch(EstimatorType::contact_kalman);
  EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, rest), 7);
}

// Too old for it, say.
TEST_F(SensorWatchTest, FramesThatTheEstimatorDoesNotUseAreStale) {
  watch(EstimatorType::motion_capture);
  used_ = 0;
  EXPECT_EQ(ticks_until(&SensorFindings::mocap_stale, nullptr), 11);
}

TEST_F(SensorWatchTest, TheEstimatorDoesNotGetAFrameTwice) {
  watch(EstimatorType::motion_capture);
  tick(), tick();
  EXPECT_TRUE(watch_->usable().mocap_fresh);
  tick([](hal::Sensors& s) {
    for (std::size_t m = 0; m < 4; ++m) s.marker[m] = {2.0, 0.1 * static_cast<double>(m), 1.0};
  });
  EXPECT_FALSE(watch_->usable().mocap_fresh);
  tick();
  EXPECT_TRUE(watch_->usable().mocap_fresh);
}

// Two real sensors do not fail together; a simulated gyroscope without errors may rest for ever
// beside an accelerometer with errors.
TEST_F(SensorWatchTest, AGyroscopeThatIsFrozenBesideAMovingAccelerometerIsStaleAndViceVersa) {
  const auto gyro = [](hal::Sensors& s) { s.gyro = {}; };
  const auto accelerometer = [](hal::Sensors& s) { s.accelerometer = {0.0, 0.0, 9.81}; };
  for (const auto& freeze : {std::function<void(hal::Sensors&)>(gyro),
                             std::function<void(hal::Sensors&)>(accelerometer)}) {
    sensors_.has_truth = sensors_.sensor_truth = false;
    watch(EstimatorType::contact_kalman);
    tick(), tick();
    EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, freeze), 7);  // the first one differs
    sensors_.has_truth = sensors_.sensor_truth = true;
    watch(EstimatorType::contact_kalman);
    EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, freeze), -1);  // it has never moved
    watch(EstimatorType::contact_kalman);
    tick(), tick();
    EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, freeze), 7);
    watch(EstimatorType::true_state);
    tick(), tick();
    EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, freeze), -1);
  }
}

TEST_F(SensorWatchTest, JointsThatRepeatToTheLastBitWhileTheyAreDrivenAreStale) {
  const auto freeze = [](hal::Sensors& s) { s.q = {}; };
  watch(EstimatorType::contact_kalman);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::joints_stale, freeze), 7);  // the first one differs
  EXPECT_FALSE(tick().joints_stale);
  watch(EstimatorType::true_state);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::joints_stale, freeze), -1);
}

TEST_F(SensorWatchTest, JointsOfWhichOneNumberMovesAreNotFrozen) {
  watch(EstimatorType::contact_kalman);
  for (const auto field : {&hal::Sensors::q, &hal::Sensors::tau, &hal::Sensors::motor}) {
    EXPECT_EQ(ticks_until(&SensorFindings::joints_stale,
                          [&](hal::Sensors& s) {
                            s.q = {};
                            (s.*field)[1] = static_cast<double>(tick_ % 2);
                          }),
              -1);
  }
}

// As long as torques on them stay within what the robot calls a step.
TEST_F(SensorWatchTest, JointsAreFrozenFromATorqueOnThatMovesNone) {
  robot_.torque_step_limit = 3.5;
  watch(EstimatorType::contact_kalman);
  tick(), tick();
  // The first one differs, and the fourth that repeats follows a command that is off by 4.
  EXPECT_EQ(ticks_until(&SensorFindings::joints_stale, [](hal::Sensors& s) { s.q = {}; }),
            1 + 3 + 6);
}

// It moves by whole counts until it rests: the first short rest tells that it has a resolution.
TEST_F(SensorWatchTest, ASimulatedAccelerometerWithoutErrorsMayRestBesideAGyroscopeWithErrors) {
  const auto rest = [](hal::Sensors& s) { s.accelerometer = {0.0, 0.0, 9.81}; };
  sensors_.has_truth = sensors_.sensor_truth = true;
  watch(EstimatorType::contact_kalman);
  tick(), tick(rest), tick(rest), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, rest), -1);
  sensors_.has_truth = sensors_.sensor_truth = false;
  watch(EstimatorType::contact_kalman);
  tick(), tick(rest), tick(rest), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::imu_stale, rest), 7);
}

// Within the resolution of their encoders, or of a simulator that never moved them.
TEST_F(SensorWatchTest, JointsAtRestAreNotFrozen) {
  const auto rest = [](hal::Sensors& s) { s.q = {}; };
  watch(EstimatorType::contact_kalman);
  tick(), tick();
  driven_ = false;
  EXPECT_EQ(ticks_until(&SensorFindings::joints_stale, rest), -1);
  driven_ = true;
  sensors_.has_truth = true;
  watch(EstimatorType::contact_kalman);
  EXPECT_EQ(ticks_until(&SensorFindings::joints_stale, rest), -1);
}

TEST_F(SensorWatchTest, AMarkerThatRepeatsWhileOthersMoveIsNotSeen) {
  watch(EstimatorType::motion_capture);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::mocap_stale,
                        [](hal::Sensors& s) {
                          s.marker[2] = {1, 2, 3};
                        }),
            -1);
  const hal::Sensors& given = watch_->usable();
  EXPECT_TRUE(given.mocap_fresh);
  EXPECT_FALSE(given.marker_seen[2]);
  EXPECT_TRUE(given.marker_seen[0] && given.marker_seen[1] && given.marker_seen[3]);
  EXPECT_EQ(given.marker[0], sensors_.marker[0]);
  tick();
  EXPECT_EQ(&watch_->usable(), &sensors_);
}

// Two that move could be the noise of a robot at rest: it takes the limit to tell, and as long for
// the fault.
TEST_F(SensorWatchTest, FramesInWhichTooFewMarkersMoveAreStale) {
  const auto freeze = [](hal::Sensors& s) { s.marker[2] = s.marker[3] = {1.0, 2.0, 3.0}; };
  watch(EstimatorType::motion_capture);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::mocap_stale, freeze), 1 + 10 + 11);
  EXPECT_FALSE(watch_->usable().marker_seen[2] || watch_->usable().marker_seen[3]);
  sensors_.has_truth = true;  // perfect ones may repeat
  watch(EstimatorType::motion_capture);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::mocap_stale, freeze), -1);
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

TEST_F(SensorWatchTest, FramesThatRepeatOrShowTooFewMarkersAreStaleWhereTheyAreNeeded) {
  const auto freeze = [](hal::Sensors& s) {
    for (auto& marker : s.marker) marker = {1.0, 2.0, 3.0};
  };
  const auto hide = [](hal::Sensors& s) { s.marker_seen = {true, true}; };
  watch(EstimatorType::motion_capture);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::mocap_stale, freeze), 12);
  watch(EstimatorType::motion_capture);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::mocap_stale, hide), 11);
  watch(EstimatorType::contact_kalman);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::mocap_stale, hide), -1);
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
