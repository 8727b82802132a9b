// The filter as an estimator: numbers that are none, and one that takes over from another.
#include "engine/estimators/contact_kalman.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "behaviors/language/estimators.h"
#include "engine/estimators/catalogue.h"
#include "tests/support/sensed_walk.h"

namespace footfall::tests {
namespace {

// The filter beside a robot that walks, with a model of its own.
struct KalmanWalk {
  explicit KalmanWalk(const SensedWalk& walk) : model(walk.rig.behavior->robot) {
    for (const auto& row : behaviors::estimator_info(kType).parameters) {
      parameters.push_back(row.value);
    }
    estimate.state.q = walk.sensors.q;
    model.update(estimate.state);
    estimator = make(walk);
  }
  std::unique_ptr<engine::Estimator> make(const SensedWalk& walk) const {
    behaviors::EstimatorSpec spec;
    spec.type = kType;
    return engine::make_estimator(spec, walk.rig.behavior->robot, model);
  }
  bool tick(const hal::Sensors& sensors, std::uint64_t support) {
    const bool done = estimator->estimate({sensors, model, support, parameters}, estimate);
    if (done) model.update(estimate.state);
    return done;
  }
  static constexpr auto kType = behaviors::EstimatorType::contact_kalman;
  model::ControlModel model;
  std::vector<double> parameters;
  std::unique_ptr<engine::Estimator> estimator;
  engine::Estimate estimate;
};

TEST(ContactKalman, ANumberThatIsNoneLeavesEverythingAsItWas) {
  SensedWalk walk(3, laboratory_errors());
  KalmanWalk spoilt(walk), clean(walk);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const std::array<std::function<void(hal::Sensors&)>, 5> spoil = {
      [](hal::Sensors& s) { s.gyro[1] = kNone; },
      [](hal::Sensors& s) { s.accelerometer[2] = kNone; },
      [](hal::Sensors& s) { s.q[4] = kEndless; }, [](hal::Sensors& s) { s.qd[0] = -kEndless; },
      [](hal::Sensors& s) { s.tau[5] = kNone; }};
  for (int k = 0; k < 1500; ++k) {
    ASSERT_TRUE(walk.next());
    if (k % 100 == 50) {  // in between, and thus without a trace
      hal::Sensors bad = walk.sensors;
      spoil[static_cast<std::size_t>(k / 100) % spoil.size()](bad);
      ASSERT_FALSE(spoilt.tick(bad, walk.support));
    }
    ASSERT_TRUE(spoilt.tick(walk.sensors, walk.support));
    ASSERT_TRUE(clean.tick(walk.sensors, walk.support));
    ASSERT_EQ(spoilt.estimate.state.q_WB, clean.estimate.state.q_WB) << k;
    ASSERT_EQ(spoilt.estimate.state.p_WB, clean.estimate.state.p_WB) << k;
    ASSERT_EQ(spoilt.estimate.quality.attitude, clean.estimate.quality.attitude) << k;
  }
}

TEST(ContactKalman, OneOfTheSameTypeGoesOnWhereTheOldOneIs) {
  SensedWalk walk(4, laboratory_errors());
  KalmanWalk one(walk), two(walk);
  for (int k = 0; k < 2000; ++k) {
    ASSERT_TRUE(walk.next());
    if (k == 1000) {
      auto fresh = two.make(walk);
      fresh->take_over(*two.estimator, two.estimate);
      two.estimator = std::move(fresh);
    }
    one.tick(walk.sensors, walk.support);
    two.tick(walk.sensors, walk.support);
    ASSERT_EQ(one.estimate.state.q_WB, two.estimate.state.q_WB) << k;
    ASSERT_EQ(one.estimate.state.v_WB, two.estimate.state.v_WB) << k;
    ASSERT_EQ(one.estimate.quality.position, two.estimate.quality.position) << k;
  }
}

// Of another type it has the estimate alone, and its own deviations of a start.
TEST(ContactKalman, AfterAnotherEstimatorItGoesOnFromItsEstimate) {
  SensedWalk walk(5, SensorErrors{});
  for (int k = 0; k < 1500; ++k) ASSERT_TRUE(walk.next());
  behaviors::EstimatorSpec spec;
  spec.type = behaviors::EstimatorType::true_state;
  KalmanWalk kalman(walk);
  const auto old = engine::make_estimator(spec, walk.rig.behavior->robot, kalman.model);
  kalman.estimate.state = walk.truth();
  kalman.model.update(kalman.estimate.state);
  kalman.estimator->take_over(*old, kalman.estimate);
  engine::ErrorCovariance covariance;
  EXPECT_FALSE(kalman.estimator->covariance(covariance));
  ASSERT_TRUE(walk.next());
  ASSERT_TRUE(kalman.tick(walk.sensors, walk.support));
  // Perfect sensors move a true state to the next one, but for the integration of a tick: half of
  // an acceleration below 50 m/s^2 times dt^2 = (1/1500 s)^2 is 11 um.
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(kalman.estimate.state.p_WB[k], walk.truth().p_WB[k], 20e-6);
    EXPECT_NEAR(kalman.estimate.state.v_WB[k], walk.truth().v_WB[k], 2e-3);
  }
  ASSERT_TRUE(kalman.estimator->covariance(covariance));
  const double tilt = kalman.parameters[engine::contact_kalman_parameter::start_attitude];
  EXPECT_NEAR(std::sqrt(covariance[0]), tilt, 0.01 * tilt);
  for (int k = 0; k < 1500; ++k) {
    ASSERT_TRUE(walk.next());
    ASSERT_TRUE(kalman.tick(walk.sensors, walk.support));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(kalman.estimate.state.v_WB[k], walk.truth().v_WB[k], 20e-3);
  }
}

// On a rope, say: after `lost_after` there is no state, and the last one stays.
TEST(ContactKalman, WithoutAFootForLongItHasNoEstimate) {
  SensedWalk walk(6, laboratory_errors());
  KalmanWalk kalman(walk);
  kalman.parameters[engine::contact_kalman_parameter::lost_after] = 0.5;
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(walk.next());
    ASSERT_TRUE(kalman.tick(walk.sensors, walk.support));
  }
  hal::Sensors lifted = walk.sensors;
  lifted.contact.fill(false);
  int ticks = 0;
  while (kalman.tick(lifted, 0) && ticks < 3000) ++ticks;
  const model::State last = kalman.estimate.state;
  // 0.5 s of 1500 ticks after the switches' debouncing of 2 ms.
  EXPECT_NEAR(ticks, 750, 5);
  EXPECT_FALSE(kalman.tick(lifted, 0));
  EXPECT_EQ(kalman.estimate.state.p_WB, last.p_WB);
}

}  // namespace
}  // namespace footfall::tests
