// Both estimators beside a simulated walk in place, with the errors of a laboratory's sensors.
#include "tests/support/sensed_walk.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "behaviors/language/estimators.h"
#include "engine/estimators/catalogue.h"
#include "engine/estimators/contact_kalman.h"
#include "engine/estimators/parts/rotation.h"

namespace footfall::tests {
namespace {

using engine::Matrix3d;
using engine::Vector3d;

// An estimator with its own model, and its errors.
class Follower {
 public:
  Follower(behaviors::EstimatorType type, const SensedWalk& walk)
      : model_(walk.rig.behavior->robot) {
    behaviors::EstimatorSpec spec;
    spec.type = type;
    estimator_ = engine::make_estimator(spec, walk.rig.behavior->robot, model_);
    for (const auto& row : behaviors::estimator_info(type).parameters) {
      parameters_.push_back(row.value);
    }
    estimate.state.q = walk.sensors.q;
    model_.update(estimate.state);
  }
  void tick(const SensedWalk& walk, bool counts) {
    if (!estimator_->estimate({walk.sensors, model_, walk.support, parameters_}, estimate)) return;
    model_.update(estimate.state);
    if (!counts) return;
    const model::State& truth = walk.truth();
    const Matrix3d R = engine::rotation_of(estimate.state.q_WB);
    attitude = engine::rotation_log(R * engine::rotation_of(truth.q_WB).transpose());
    place = Vector3d(estimate.state.p_WB.data()) - Vector3d(truth.p_WB.data());
    const Vector3d velocity =
        Vector3d(model_.com().velocity.data()) - Vector3d(walk.true_model().com().velocity.data());
    attitude_squares_ += attitude.cwiseAbs2();
    velocity_squares_ += velocity.cwiseAbs2();
    ++count_;
    engine::ErrorCovariance covariance;
    if (!estimator_->covariance(covariance)) return;
    const Eigen::Map<const Eigen::Matrix<double, 9, 9>> P(covariance.data());
    const Vector3d v = Vector3d(estimate.state.v_WB.data()) - Vector3d(truth.v_WB.data());
    nees_tilt_ += attitude.head<2>().dot(P.topLeftCorner<2, 2>().inverse() * attitude.head<2>());
    nees_velocity_ += v.dot(P.block<3, 3>(3, 3).inverse() * v);
  }
  Vector3d attitude_rms() const { return (attitude_squares_ / count_).cwiseSqrt(); }
  Vector3d velocity_rms() const { return (velocity_squares_ / count_).cwiseSqrt(); }
  double nees_tilt() const { return nees_tilt_ / count_; }
  double nees_velocity() const { return nees_velocity_ / count_; }

  engine::Estimate estimate;
  Vector3d attitude, place;  // last errors, rad and m

 private:
  model::ControlModel model_;
  std::unique_ptr<engine::Estimator> estimator_;
  std::vector<double> parameters_;
  Vector3d attitude_squares_ = Vector3d::Zero(), velocity_squares_ = Vector3d::Zero();
  double nees_tilt_ = 0.0, nees_velocity_ = 0.0, count_ = 0.0;
};

constexpr double kDegree = 0.017453292519943295;

TEST(SensedWalk, PerfectSensorsLeaveOnlyTheFiltersLag) {
  SensedWalk walk(1, SensorErrors{});
  Follower mocap(behaviors::EstimatorType::motion_capture, walk);
  Follower kalman(behaviors::EstimatorType::contact_kalman, walk);
  while (walk.next() && walk.rig.loop->time() < 4.0) {
    mocap.tick(walk, walk.rig.loop->time() > 2.0);
    kalman.tick(walk, walk.rig.loop->time() > 2.0);
  }
  EXPECT_GE(walk.rig.loop->time(), 4.0);
  EXPECT_LT(mocap.attitude_rms().maxCoeff(), 1e-6);
  EXPECT_LT(kalman.attitude_rms().maxCoeff(), 1e-3);
  EXPECT_LT(mocap.velocity_rms().maxCoeff(), 3e-3);
  EXPECT_LT(kalman.velocity_rms().maxCoeff(), 3e-3);
}

TEST(SensedWalk, MotionCaptureKeepsWithinItsBars) {
  SensedWalk walk(11, laboratory_errors());
  Follower mocap(behaviors::EstimatorType::motion_capture, walk);
  while (walk.next() && walk.rig.loop->time() < 8.0) {
    mocap.tick(walk, walk.rig.loop->time() > 4.0);
  }
  EXPECT_GE(walk.rig.loop->time(), 8.0);
  // Markers misplaced by 1 mm tilt the pattern by up to 1 mm / 0.14 m.
  EXPECT_LT(mocap.attitude_rms().maxCoeff(), 8e-3);
  EXPECT_LT(mocap.velocity_rms().maxCoeff(), 10e-3);
  EXPECT_LT(mocap.place.norm(), 3e-3);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(mocap.estimate.quality.gyro_bias[k], walk.gyro_bias[k], 0.05 * kDegree);
  }
}

TEST(SensedWalk, WithoutMotionCaptureTiltAndVelocityKeepWithinTheirBars) {
  SensedWalk walk(12, laboratory_errors());
  Follower kalman(behaviors::EstimatorType::contact_kalman, walk);
  std::array<double, 3> early{};
  while (walk.next() && walk.rig.loop->time() < 20.0) {
    kalman.tick(walk, walk.rig.loop->time() > 10.0);
    if (walk.rig.loop->time() < 2.0) early = kalman.estimate.quality.attitude;
  }
  EXPECT_GE(walk.rig.loop->time(), 20.0);
  EXPECT_LT(kalman.attitude_rms().head<2>().maxCoeff(), 8e-3);
  EXPECT_LT(kalman.velocity_rms().maxCoeff(), 10e-3);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(kalman.estimate.quality.gyro_bias[k], walk.gyro_bias[k], 0.03 * kDegree);
  }
  EXPECT_GT(kalman.estimate.quality.attitude[2], 2.0 * early[2]);  // of the heading
  // One draw of the accelerometer's bias, which makes most of the tilt's error: chi squared with
  // two degrees of freedom is below 13.8 with a probability of 0.999.
  EXPECT_LT(kalman.nees_tilt(), 13.8);
  EXPECT_GT(kalman.nees_velocity(), 0.3);
  EXPECT_LT(kalman.nees_velocity(), 6.0);
}

TEST(SensedWalk, MotionCaptureComesThroughBlindSeconds) {
  SensedWalk walk(13, laboratory_errors());
  Follower mocap(behaviors::EstimatorType::motion_capture, walk);
  while (walk.next() && walk.rig.loop->time() < 6.0) {
    walk.blind = walk.rig.loop->time() > 4.0;
    mocap.tick(walk, walk.blind);
  }
  EXPECT_EQ(mocap.estimate.quality.markers, 0);
  EXPECT_LT(mocap.velocity_rms().maxCoeff(), 20e-3);
  EXPECT_LT(mocap.attitude.norm(), 12e-3);
  EXPECT_LT(mocap.place.norm(), 0.05);
}

TEST(ContactKalman, ItsTableAndItsParametersAgree) {
  namespace parameter = engine::contact_kalman_parameter;
  const auto rows = behaviors::estimator_info(behaviors::EstimatorType::contact_kalman).parameters;
  ASSERT_EQ(rows.size(), parameter::count);
  EXPECT_EQ(rows[engine::measured_parameter::anchor_release].name, "anchor_release");
  EXPECT_EQ(rows[parameter::gyro_noise].name, "gyro_noise");
  EXPECT_EQ(rows[parameter::accelerometer_noise].name, "accelerometer_noise");
  EXPECT_EQ(rows[parameter::gyro_bias_walk].name, "gyro_bias_walk");
  EXPECT_EQ(rows[parameter::accelerometer_bias_walk].name, "accelerometer_bias_walk");
  EXPECT_EQ(rows[parameter::foot_noise].name, "foot_noise");
  EXPECT_EQ(rows[parameter::foot_slip].name, "foot_slip");
  EXPECT_EQ(rows[parameter::slip_gate].name, "slip_gate");
  EXPECT_EQ(rows[parameter::ground_noise].name, "ground_noise");
  EXPECT_EQ(rows[parameter::start_attitude].name, "start_attitude");
  EXPECT_EQ(rows[parameter::start_velocity].name, "start_velocity");
  EXPECT_EQ(rows[parameter::start_gyro_bias].name, "start_gyro_bias");
  EXPECT_EQ(rows[parameter::start_accelerometer_bias].name, "start_accelerometer_bias");
  EXPECT_EQ(rows[parameter::lost_after].name, "lost_after");
}

}  // namespace
}  // namespace footfall::tests
