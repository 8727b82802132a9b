// Sensors that say the same to the last bit, again and again.
#include "tests/unit/engine/watch/watch_test_support.h"

namespace footfall::tests {
namespace {

class FrozenSensorTest : public WatchTest {};

TEST_F(FrozenSensorTest, AFrozenImuIsStaleWhereItIsNeeded) {
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
TEST_F(FrozenSensorTest, AnImuThatHasNeverMovedIsFrozenUnlessItIsPerfect) {
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

TEST_F(FrozenSensorTest, TheEstimatorDoesNotGetAFrameTwice) {
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
TEST_F(FrozenSensorTest, AGyroscopeThatIsFrozenBesideAMovingAccelerometerIsStaleAndViceVersa) {
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

TEST_F(FrozenSensorTest, JointsThatRepeatToTheLastBitWhileTheyAreDrivenAreStale) {
  const auto freeze = [](hal::Sensors& s) { s.q = {}; };
  watch(EstimatorType::contact_kalman);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::joints_stale, freeze), 7);  // the first one differs
  EXPECT_FALSE(tick().joints_stale);
  watch(EstimatorType::true_state);
  tick(), tick();
  EXPECT_EQ(ticks_until(&SensorFindings::joints_stale, freeze), -1);
}

TEST_F(FrozenSensorTest, JointsOfWhichOneNumberMovesAreNotFrozen) {
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
TEST_F(FrozenSensorTest, JointsAreFrozenFromATorqueOnThatMovesNone) {
  robot_.torque_step_limit = 3.5;
  watch(EstimatorType::contact_kalman);
  tick(), tick();
  // The first one differs, and the fourth that repeats follows a command that is off by 4.
  EXPECT_EQ(ticks_until(&SensorFindings::joints_stale, [](hal::Sensors& s) { s.q = {}; }),
            1 + 3 + 6);
}

// It moves by whole counts until it rests: the first short rest tells that it has a resolution.
TEST_F(FrozenSensorTest, ASimulatedAccelerometerWithoutErrorsMayRestBesideAGyroscopeWithErrors) {
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
TEST_F(FrozenSensorTest, JointsAtRestAreNotFrozen) {
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

TEST_F(FrozenSensorTest, AMarkerThatRepeatsWhileOthersMoveIsNotSeen) {
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
TEST_F(FrozenSensorTest, FramesInWhichTooFewMarkersMoveAreStale) {
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

TEST_F(FrozenSensorTest, FramesThatRepeatOrShowTooFewMarkersAreStaleWhereTheyAreNeeded) {
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

}  // namespace
}  // namespace footfall::tests
