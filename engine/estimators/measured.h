// What every estimator begins with that measures: joints, contacts and the IMU, in common frames.
#pragma once

#include "engine/estimators/estimator.h"
#include "engine/estimators/parts/contact_filter.h"
#include "engine/estimators/parts/foot_kinematics.h"
#include "engine/estimators/parts/joint_filter.h"

namespace footfall::engine {

// The first parameters of those estimators, in the order of their tables
// (behaviors/language/estimators.cc).
namespace measured_parameter {
enum : std::size_t {
  joint_velocity_filter,
  encoder_time,
  contact_debounce,
  contact_force,
  anchor_settle,
  anchor_release,
  count,
};
}  // namespace measured_parameter

// A foot that keeps its place in this tick.
struct Anchor {
  int contact = 0;
  FootKinematics foot;
};

class Measured {
 public:
  // Throws std::runtime_error if the robot's model has no IMU.
  Measured(const behaviors::EstimatorSpec& spec, const model::RobotDescription& robot,
           const model::ControlModel& model);
  // False: a number that is not finite, or too few parameters; nothing has changed then. Else
  // writes q, qd and the contacts.
  bool update(const EstimatorInput& input, Estimate& estimate) noexcept;
  void take_over(const Measured& old) noexcept;

  double period() const noexcept { return period_; }
  const Vector3d& gyro() const noexcept { return gyro_; }                    // rad/s, base axes
  const Vector3d& accelerometer() const noexcept { return accelerometer_; }  // m/s^2, base axes
  const Vector3d& imu() const noexcept { return p_BI_; }                     // m, base frame
  const Matrix3d& R_BI() const noexcept { return R_BI_; }
  std::span<const Anchor> anchors() const noexcept {
    return std::span(anchors_).first(static_cast<std::size_t>(anchor_count_));
  }
  // The base as its feet see it: mean over the anchors of -(w x r + J_leg q̇), m/s, base axes, of
  // the base's origin for the angular velocity w (rad/s, base axes). Zero without an anchor.
  Vector3d leg_velocity(const Vector3d& w) const noexcept;

 private:
  double period_;
  Vector3d p_BI_;
  Matrix3d R_BI_;
  JointFilter joints_;
  ContactFilter contacts_;
  Vector3d gyro_ = Vector3d::Zero(), accelerometer_ = Vector3d::Zero();
  std::array<Anchor, core::kMaxContacts> anchors_{};
  int anchor_count_ = 0;
};

}  // namespace footfall::engine
