// The estimator `motion_capture` on motions that are known exactly.
#include "engine/estimators/motion_capture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "behaviors/language/estimators.h"
#include "engine/estimators/catalogue.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

namespace parameter = engine::motion_capture_parameter;
using engine::Matrix3d;
using engine::Vector3d;

struct MocapPose {
  Matrix3d R;
  Vector3d p, v;
};

// A floating base whose rate and acceleration are constant within a tick, exactly as sensors that
// average over it tell; frames are 7.5 ticks old and come every third tick.
class MocapFlight {
 public:
  static constexpr double kAge = 7.5;  // ticks

  MocapFlight() : robot_(load_hume()), model_(robot_) {
    model_.update(standing_state(robot_));
    for (const auto& row :
         behaviors::estimator_info(behaviors::EstimatorType::motion_capture).parameters) {
      parameters.push_back(row.value);
    }
    estimator = make();
    poses_.push_back({Matrix3d::Identity(), {0.1, 0.2, 0.8}, Vector3d::Zero()});
    estimate.state = standing_state(robot_);
  }
  std::unique_ptr<engine::Estimator> make() const {
    behaviors::EstimatorSpec spec;
    spec.type = behaviors::EstimatorType::motion_capture;
    return engine::make_estimator(spec, robot_, model_);
  }

  // The next tick; whether there is a state.
  bool tick() {
    const double dt = robot_.period_s(), t = dt * static_cast<double>(tick_);
    const Vector3d r(model_.mounts().p_BI.data());
    // It rests until the first frames are as old as they get.
    const double go = t < 0.02 ? 0.0 : 1.0;
    const Vector3d w = go * Vector3d(std::sin(5.0 * t), 0.8 * std::cos(3.0 * t), -0.5);
    const Vector3d v_next =
        go * Vector3d(0.3 * std::sin(4.0 * t), -0.2 * t, 0.1 * std::cos(7.0 * t));
    const MocapPose& last = poses_.back();
    MocapPose next;
    next.R = last.R * engine::rotation_exp(dt * w);
    next.v = v_next;
    next.p = last.p + 0.5 * dt * (last_origin_velocity(last, w, r) + next.v);
    const Vector3d imu_last = last_imu_, imu_next = next.v + next.R * w.cross(r);
    const Matrix3d middle = last.R * engine::rotation_exp(0.5 * dt * w);
    const Vector3d force =
        middle.transpose() * ((imu_next - imu_last) / dt + Vector3d(0, 0, model_.gravity()));
    last_imu_ = imu_next;
    poses_.push_back(next);
    sensors.gyro = engine::array_of(w + gyro_bias);
    sensors.accelerometer = engine::array_of(force);
    sensors.mocap_fresh = tick_ % 3 == 0 && !lost;
    sensors.mocap_age = kAge * dt;
    if (sensors.mocap_fresh) see();
    ++tick_;
    return estimator->estimate({sensors, model_, 0, parameters}, estimate);
  }
  const MocapPose& truth() const { return poses_.back(); }
  double attitude_error() const {
    const Matrix3d R = engine::rotation_of(estimate.state.q_WB);
    return engine::rotation_log(R * truth().R.transpose()).norm();
  }
  double position_error() const {
    return (Vector3d(estimate.state.p_WB.data()) - truth().p).norm();
  }
  double velocity_error() const {
    return (Vector3d(estimate.state.v_WB.data()) - truth().v).norm();
  }

  std::vector<double> parameters;
  std::unique_ptr<engine::Estimator> estimator;
  engine::Estimate estimate;
  hal::Sensors sensors;
  Vector3d gyro_bias = Vector3d::Zero();
  bool lost = false;                  // no frames
  int seen = 7;                       // markers
  Vector3d moved = Vector3d::Zero();  // of the third marker, m, world

 private:
  // The IMU's velocity goes on; the origin's jumps with the rate at the tick's start.
  Vector3d last_origin_velocity(const MocapPose& last, const Vector3d& w, const Vector3d& r) const {
    return last_imu_ - last.R * w.cross(r);
  }
  // Half a tick before a pose, the motion being uniform in between.
  void see() {
    const auto k = static_cast<std::ptrdiff_t>(poses_.size()) - 1 - 8;
    MocapPose then = poses_.front();
    if (k >= 0) {
      const MocapPose& a = poses_[static_cast<std::size_t>(k)];
      const MocapPose& b = poses_[static_cast<std::size_t>(k) + 1];
      then.R = a.R * engine::rotation_exp(0.5 * engine::rotation_log(a.R.transpose() * b.R));
      then.p = 0.5 * (a.p + b.p);
    }
    const auto& markers = model_.mounts().markers;
    for (std::size_t m = 0; m < markers.size(); ++m) {
      sensors.marker_seen[m] = static_cast<int>(m) < seen;
      const Vector3d off = m == 2 ? moved : Vector3d(0.0, 0.0, 0.0);
      sensors.marker[m] =
          engine::array_of(then.p + then.R * Vector3d(markers[m].p_BM.data()) + off);
    }
  }

  model::RobotDescription robot_;
  model::ControlModel model_;
  std::vector<MocapPose> poses_;
  Vector3d last_imu_ = Vector3d::Zero();
  long tick_ = 0;
};

TEST(MotionCapture, ItsTableAndItsParametersAgree) {
  const auto rows = behaviors::estimator_info(behaviors::EstimatorType::motion_capture).parameters;
  ASSERT_EQ(rows.size(), parameter::count);
  namespace measured = engine::measured_parameter;
  EXPECT_EQ(rows[measured::joint_velocity_filter].name, "joint_velocity_filter");
  EXPECT_EQ(rows[measured::encoder_time].name, "encoder_time");
  EXPECT_EQ(rows[measured::contact_debounce].name, "contact_debounce");
  EXPECT_EQ(rows[measured::contact_force].name, "contact_force");
  EXPECT_EQ(rows[measured::anchor_settle].name, "anchor_settle");
  EXPECT_EQ(rows[measured::anchor_release].name, "anchor_release");
  EXPECT_EQ(rows[parameter::lambda].name, "lambda");
  EXPECT_EQ(rows[parameter::gyro_bias_gain].name, "gyro_bias_gain");
  EXPECT_EQ(rows[parameter::oldest_frame].name, "oldest_frame");
  EXPECT_EQ(rows[parameter::position_gain].name, "position_gain");
  EXPECT_EQ(rows[parameter::velocity_gain].name, "velocity_gain");
  EXPECT_EQ(rows[parameter::leg_velocity_time].name, "leg_velocity_time");
  EXPECT_EQ(rows[parameter::acceleration_gain].name, "acceleration_gain");
  EXPECT_EQ(rows[parameter::regain_after].name, "regain_after");
  EXPECT_EQ(rows[parameter::marker_gate].name, "marker_gate");
}

// E17: the turn since exposure is the product of exp([w]x dt), so that old frames correct nothing
// where there is nothing to correct.
TEST(MotionCapture, PerfectSensorsGiveTheMotionExactly) {
  MocapFlight flight;
  for (int i = 0; i < 4500; ++i) {
    ASSERT_TRUE(flight.tick());
    ASSERT_LT(flight.attitude_error(), 1e-9) << i;
    ASSERT_LT(flight.position_error(), 1e-9) << i;
    ASSERT_LT(flight.velocity_error(), 1e-9) << i;
  }
  EXPECT_EQ(flight.estimate.quality.markers, 7);
}

TEST(MotionCapture, AnOrientationThatIsOffComesBackByTheGainOfAFrame) {
  MocapFlight flight;
  flight.parameters[parameter::gyro_bias_gain] = 0.0;
  flight.parameters[parameter::regain_after] = 1e6;  // never
  flight.tick();
  engine::Estimate wrong = flight.estimate;
  const Matrix3d off = engine::rotation_exp(Vector3d(0.0, 0.0, 0.01));
  wrong.state.q_WB = engine::quaternion_of(off * engine::rotation_of(wrong.state.q_WB));
  class Other final : public engine::Estimator {
    bool estimate(const engine::EstimatorInput&, engine::Estimate&) noexcept override {
      return false;
    }
  };
  flight.estimator = flight.make();
  flight.estimator->take_over(Other(), wrong);
  flight.estimate = wrong;
  // Resting, upright, lambda 2 m: about z the mean of the gains of x and y, 0.034/4.034 and
  // 0.078/4.078. The history must first be as long as a frame is old.
  double before = 0.0;
  for (int i = 0; i < 21; ++i) {
    if (i == 18) before = flight.attitude_error();
    ASSERT_TRUE(flight.tick());
  }
  EXPECT_NEAR(flight.attitude_error() / before, 1.0 - 0.5 * (0.00843 + 0.0192), 1e-3);
}

TEST(MotionCapture, TheGyrosBiasIsFound) {
  MocapFlight flight;
  flight.gyro_bias = {0.004, -0.003, 0.005};
  for (int i = 0; i < 45000; ++i) ASSERT_TRUE(flight.tick());
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(flight.estimate.quality.gyro_bias[k], flight.gyro_bias[static_cast<int>(k)], 1e-5);
  }
  EXPECT_LT(flight.attitude_error(), 2e-5);
}

TEST(MotionCapture, WithoutTheIntegralABiasStaysAnError) {
  MocapFlight flight;
  flight.parameters[parameter::gyro_bias_gain] = 0.0;
  flight.gyro_bias = {0.004, -0.003, 0.005};
  for (int i = 0; i < 15000; ++i) flight.tick();
  EXPECT_GT(flight.attitude_error(), 3e-4);
  EXPECT_EQ(flight.estimate.quality.gyro_bias[0], 0.0);
}

TEST(MotionCapture, OneMarkerIsEnoughOnceItHasStarted) {
  MocapFlight flight;
  flight.seen = 2;
  EXPECT_FALSE(flight.tick());
  flight.seen = 7;
  for (int i = 0; i < 3; ++i) flight.tick();
  flight.seen = 1;
  for (int i = 0; i < 1500; ++i) ASSERT_TRUE(flight.tick());
  EXPECT_LT(flight.attitude_error(), 1e-9);
  EXPECT_LT(flight.position_error(), 1e-9);
  EXPECT_EQ(flight.estimate.quality.markers, 1);
}

// One marker moved by 10 cm, before the start and while it runs: not used, and of no effect.
TEST(MotionCapture, AMarkerThatDisagreesWithTheOthersHasNoEffect) {
  MocapFlight flight;
  flight.moved = {0.0, 0.1, 0.0};
  for (int i = 0; i < 1500; ++i) {
    const bool known = flight.tick();
    ASSERT_TRUE(known || i == 0) << i;
  }
  EXPECT_EQ(flight.estimate.quality.markers, 6);
  EXPECT_LT(flight.attitude_error(), 1e-9);
  EXPECT_LT(flight.position_error(), 1e-9);
}

TEST(MotionCapture, WithoutMarkersItGoesOnByTheImu) {
  MocapFlight flight;
  for (int i = 0; i < 300; ++i) flight.tick();
  flight.seen = 0;
  for (int i = 0; i < 3000; ++i) ASSERT_TRUE(flight.tick());
  EXPECT_EQ(flight.estimate.quality.markers, 0);
  EXPECT_LT(flight.attitude_error(), 1e-9);
  EXPECT_LT(flight.velocity_error(), 1e-9);
}

// A second without frames, in which the gyro's bias and no feet let it drift: the first frame puts
// it right at once, and no velocity is made of the distance.
TEST(MotionCapture, AfterALongGapTheFirstFrameIsTakenAsItIs) {
  MocapFlight flight;
  for (int k = 0; k < 60; ++k) flight.tick();
  flight.gyro_bias = {0.05, -0.05, 0.05};
  flight.lost = true;
  for (int k = 0; k < 1500; ++k) flight.tick();
  EXPECT_GT(flight.attitude_error(), 0.05);
  const double place = flight.position_error(), velocity = flight.velocity_error();
  EXPECT_GT(place, 0.05);
  flight.lost = false;
  do flight.tick();
  while (!flight.sensors.mocap_fresh);
  // The bias over a frame's age, and the drifting velocity over it.
  const double age = flight.sensors.mocap_age;
  EXPECT_LT(flight.attitude_error(), 0.1 * age);
  EXPECT_LT(flight.position_error(), (velocity + 0.1) * age);
  EXPECT_LT(flight.velocity_error(), velocity + 0.1);
}
TEST(MotionCapture, ANumberThatIsNoneLeavesTheEstimateAlone) {
  MocapFlight flight;
  for (int i = 0; i < 30; ++i) flight.tick();
  const auto before = flight.estimate.state.q_WB;
  flight.sensors.q[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(flight.tick());
  EXPECT_EQ(flight.estimate.state.q_WB, before);
}

TEST(MotionCapture, AnEstimatorOfTheSameTypeGoesOnWhereTheOldOneIs) {
  MocapFlight one, two;
  for (int i = 0; i < 1000; ++i) {
    one.tick();
    two.tick();
  }
  auto fresh = two.make();
  fresh->take_over(*two.estimator, two.estimate);
  two.estimator = std::move(fresh);
  for (int i = 0; i < 100; ++i) {
    one.tick();
    two.tick();
    ASSERT_EQ(one.estimate.state.q_WB, two.estimate.state.q_WB);
    ASSERT_EQ(one.estimate.state.p_WB, two.estimate.state.p_WB);
  }
}

TEST(MotionCapture, ItAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer counts nothing";
  MocapFlight flight;
  for (int i = 0; i < 30; ++i) flight.tick();
  const model::ControlModel model(load_hume());
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    flight.estimator->estimate({flight.sensors, model, 0, flight.parameters}, flight.estimate);
  }
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
