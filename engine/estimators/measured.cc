// Joints, contacts and the IMU; see measured.h.
#include "engine/estimators/measured.h"

#include <cmath>
#include <stdexcept>

#include "core/index.h"

namespace footfall::engine {
namespace {

// A sum is finite only if all of its terms are (or it overflows, which is as bad).
bool finite_sensors(const hal::Sensors& s, int joints) noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) sum += s.gyro[k] + s.accelerometer[k];
  for (std::size_t j = 0; j < at(joints); ++j) sum += s.q[j] + s.qd[j] + s.tau[j] + s.motor[j];
  return std::isfinite(sum);
}

}  // namespace

Measured::Measured(const behaviors::EstimatorSpec& spec, const model::RobotDescription& robot,
                   const model::ControlModel& model)
    : period_(robot.period_s()),
      p_BI_(vector_of(model.mounts().p_BI)),
      R_BI_(matrix_of(model.mounts().R_BI)),
      joints_(robot),
      contacts_(robot, spec.contact) {
  if (!model.mounts().has_imu) {
    throw std::runtime_error("robot '" + robot.name + "' has no IMU, which its estimator needs");
  }
}

bool Measured::update(const EstimatorInput& input, Estimate& estimate) noexcept {
  namespace parameter = measured_parameter;
  const std::span<const double> p = input.parameters;
  if (p.size() < parameter::count || !finite_sensors(input.sensors, joints_.count())) return false;
  gyro_ = R_BI_ * vector_of(input.sensors.gyro);
  accelerometer_ = R_BI_ * vector_of(input.sensors.accelerometer);
  joints_.update(input.sensors, input.joints_fresh, p[parameter::joint_velocity_filter],
                 p[parameter::encoder_time], estimate.state);
  contacts_.update(input.sensors, input.model, input.support,
                   {.debounce = p[parameter::contact_debounce],
                    .force = p[parameter::contact_force],
                    .settle = p[parameter::anchor_settle],
                    .release = p[parameter::anchor_release]});
  estimate.contact = contacts_.contact();
  anchor_count_ = 0;
  for (int c = 0; c < contacts_.count(); ++c) {
    if (!contacts_.anchor(c)) continue;
    anchors_[at(anchor_count_++)] = {c, foot_kinematics(input.model, c, estimate.state)};
  }
  return true;
}

void Measured::take_over(const Measured& old) noexcept {
  joints_ = old.joints_;
  contacts_.take_over(old.contacts_);
}

Vector3d Measured::leg_velocity(const Vector3d& w) const noexcept {
  Vector3d sum = Vector3d::Zero();
  for (const Anchor& a : anchors()) sum -= w.cross(a.foot.contact) + a.foot.velocity;
  return anchor_count_ > 0 ? Vector3d(sum / anchor_count_) : sum;
}

}  // namespace footfall::engine
