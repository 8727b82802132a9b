// Prediction by the IMU, corrections by legs and frames; see motion_capture.h.
#include "engine/estimators/motion_capture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/index.h"
#include "engine/estimators/parts/marker_gate.h"

namespace footfall::engine {

namespace mocap = motion_capture_parameter;

MotionCapture::MotionCapture(const behaviors::EstimatorSpec& spec,
                             const model::RobotDescription& robot, const model::ControlModel& model)
    : measured_(spec, robot, model), gravity_(model.gravity()), memory_(robot.period_s()) {
  for (const model::Marker& marker : model.mounts().markers) {
    places_.push_back(vector_of(marker.p_BM));
  }
  if (places_.size() < 3) {
    throw std::runtime_error("robot '" + robot.name +
                             "' has fewer than three markers, which its estimator needs");
  }
}

// The seen markers of a frame; one whose position is not finite is not seen.
int MotionCapture::collect_markers(const hal::Sensors& sensors) noexcept {
  int count = 0;
  for (std::size_t m = 0; m < places_.size(); ++m) {
    const auto position = vector_of(sensors.marker[m]);
    if (!sensors.marker_seen[m] || !position.allFinite()) continue;
    pairs_[at(count++)] = {places_[m], position};
  }
  return count;
}

bool MotionCapture::start(const EstimatorInput& input) noexcept {
  if (!input.sensors.mocap_fresh) return false;
  if (!(input.sensors.mocap_age <= input.parameters[mocap::oldest_frame])) return false;
  const std::span<MarkerPair> all = std::span(pairs_).first(at(collect_markers(input.sensors)));
  Matrix3d R;
  const int count = agreeing_rotation(all, input.parameters[mocap::marker_gate], R);
  if (count == 0) return false;
  const std::span<const MarkerPair> seen = all.first(at(count));
  memory_.R = R * rotation_exp(input.sensors.mocap_age * rate_);
  memory_.velocity = memory_.R * measured_.leg_velocity(rate_);
  memory_.position =
      fit_affine(seen, R, 0.0).origin(R) + input.sensors.mocap_age * memory_.velocity;
  memory_.velocity += arm_velocity();
  memory_.markers = count;
  memory_.history.add(Vector3d::Zero(), Vector3d::Zero());
  memory_.started = true;
  return true;
}

// Over a tick with its mean rate and acceleration: R' = R exp([w]x dt) (E17), v' = v + a dt, and
// the base's origin by the mean of its velocities.
void MotionCapture::predict() noexcept {
  const double dt = measured_.period();
  Memory& m = memory_;
  const Vector3d origin_before = m.velocity - m.R * rate_.cross(measured_.imu());
  const Matrix3d middle = m.R * rotation_exp(0.5 * dt * rate_);
  m.R = m.R * rotation_exp(dt * rate_);
  m.velocity +=
      dt * (middle * measured_.accelerometer() - Vector3d(0.0, 0.0, gravity_) + m.acceleration);
  const Vector3d shift = 0.5 * dt * (origin_before + m.velocity - arm_velocity());
  m.position += shift;
  m.history.add(dt * rate_, shift);
}

void MotionCapture::correct_by_legs(std::span<const double> parameters,
                                    EstimateQuality& quality) noexcept {
  if (measured_.anchors().empty()) return;
  const double dt = measured_.period();
  Memory& m = memory_;
  const Vector3d legs = m.R * measured_.leg_velocity(rate_) + arm_velocity();
  const Vector3d error = legs - m.velocity;
  for (const Anchor& a : measured_.anchors()) {
    const Vector3d one = -m.R * (rate_.cross(a.foot.contact) + a.foot.velocity) + arm_velocity();
    quality.kinematic_innovation =
        std::max(quality.kinematic_innovation, (one - m.velocity).norm());
  }
  const double share = low_pass_share(dt, parameters[mocap::leg_velocity_time]);
  m.velocity += share * error;
  m.acceleration += parameters[mocap::acceleration_gain] * share * error;
}

// Error: of the position, m, world; interval: since the last frame, s.
void MotionCapture::correct_place(std::span<const double> parameters, const Vector3d& error,
                                  double interval) noexcept {
  const double share = std::min(1.0, parameters[mocap::position_gain] * interval);
  const Vector3d velocity = parameters[mocap::velocity_gain] * interval * error;
  memory_.position += share * error;
  memory_.velocity += velocity;
  memory_.acceleration += parameters[mocap::acceleration_gain] * velocity;
}

// After a long gap the place is wrong by what the legs slipped, or by metres where none touched: to
// correct it through the gains would make a velocity of it. The velocity turns with the heading.
bool MotionCapture::regain(std::span<MarkerPair> seen, double gate, const Motion& motion) noexcept {
  Memory& m = memory_;
  Matrix3d R;
  const int count = agreeing_rotation(seen, gate, R);
  if (count == 0) return false;
  seen = seen.first(at(count));
  m.markers = count;
  const Matrix3d now = R * motion.turn;
  m.velocity = now * m.R.transpose() * m.velocity;
  m.position = fit_affine(seen, R, 0.0).origin(R) + motion.shift;
  m.R = now;
  m.frame_time = 0.0;
  return true;
}

void MotionCapture::correct_by_frame(const EstimatorInput& input,
                                     EstimateQuality& quality) noexcept {
  Memory& m = memory_;
  m.frame_time += measured_.period();
  if (!input.sensors.mocap_fresh) return;
  const std::span<const double> p = input.parameters;
  const double age = input.sensors.mocap_age;
  Motion motion;
  m.markers = 0;
  if (!(age <= p[mocap::oldest_frame]) || !m.history.since(age, motion)) return;
  const std::span<MarkerPair> all = std::span(pairs_).first(at(collect_markers(input.sensors)));
  const bool lost = m.frame_time > p[mocap::regain_after];
  if (lost && regain(all, p[mocap::marker_gate], motion)) return;
  // At exposure: as predicted, and as the frame corrects it.
  const Matrix3d predicted = m.R * motion.turn.transpose();
  m.markers = agreeing_markers(all, predicted, p[mocap::marker_gate]);
  if (m.markers == 0) return;
  const std::span<const MarkerPair> seen = all.first(at(m.markers));
  quality.marker_innovation = marker_residual(seen, predicted, m.position - motion.shift);
  const AffineFit fit = fit_affine(seen, predicted, p[mocap::lambda]);
  const Matrix3d R = closest_rotation(fit.A);
  const Vector3d turned = rotation_log(predicted.transpose() * R);
  m.gyro_bias -= p[mocap::gyro_bias_gain] * (motion.turn.transpose() * turned);
  m.R = R * motion.turn;
  // A long gap is no reason for a long stride: the gains are those of a frame in time.
  const double interval = std::min(m.frame_time, p[mocap::oldest_frame]);
  correct_place(p, fit.origin(R) + motion.shift - m.position, interval);
  m.frame_time = 0.0;
}

void MotionCapture::write(Estimate& estimate) const noexcept {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const Memory& m = memory_;
  model::State& state = estimate.state;
  state.p_WB = array_of(m.position);
  state.q_WB = quaternion_of(m.R);
  state.v_WB = array_of(m.velocity - arm_velocity());
  state.w_WB_B = array_of(rate_);
  EstimateQuality& quality = estimate.quality;
  quality.gyro_bias = array_of(measured_.R_BI().transpose() * m.gyro_bias);
  quality.accelerometer_bias.fill(kUnknown);
  quality.attitude.fill(kUnknown);
  quality.position.fill(kUnknown);
  quality.velocity.fill(kUnknown);
  quality.markers = m.markers;
}

bool MotionCapture::estimate(const EstimatorInput& input, Estimate& estimate) noexcept {
  if (input.parameters.size() < mocap::count) return false;
  if (!memory_.started && !input.sensors.mocap_fresh) return false;
  Estimate next = estimate;
  if (!measured_.update(input, next)) return false;
  next.quality.marker_innovation = next.quality.kinematic_innovation = 0.0;
  rate_ = measured_.gyro() - memory_.gyro_bias;
  if (memory_.started) {
    predict();
    correct_by_legs(input.parameters, next.quality);
    correct_by_frame(input, next.quality);
  } else if (!start(input)) {
    return false;
  }
  write(next);
  estimate = next;
  return true;
}

void MotionCapture::take_over(const Estimator& old, const Estimate& last) noexcept {
  if (const auto* same = dynamic_cast<const MotionCapture*>(&old)) {
    measured_.take_over(same->measured_);
    memory_ = same->memory_;
    rate_ = same->rate_;
    return;
  }
  memory_.R = rotation_of(last.state.q_WB);
  rate_ = vector_of(last.state.w_WB_B);
  memory_.position = vector_of(last.state.p_WB);
  memory_.velocity = vector_of(last.state.v_WB) + arm_velocity();
  // The other's world may be another one: the first frame says where this one is.
  constexpr double kLongAgo = 1e5;  // s
  memory_.frame_time = kLongAgo;
  memory_.started = true;
}

}  // namespace footfall::engine
