// Checks and clamps; see safety.h.
#include "engine/safety.h"

#include <algorithm>
#include <cmath>

namespace footfall::engine {

using core::Fault;

SafetyFilter::SafetyFilter(const model::RobotDescription& robot) : robot_(robot) {}

SafetyFindings SafetyFilter::check_state(const hal::Sensors& sensors,
                                         const model::ControlModel& model) noexcept {
  SafetyFindings findings;
  if (sensors.backend_fault) findings.add(Fault::simulator_warning);
  if (!sensors.imu_fresh) findings.add(Fault::imu_stale);
  if (!sensors.mocap_fresh) findings.add(Fault::mocap_stale);
  const model::State& state = model.state();
  bool finite = true;
  for (int j = 0; j < model.joint_count(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    finite &= std::isfinite(state.q[i]) && std::isfinite(state.qd[i]);
    const model::JointDescription& joint = robot_.joints[i];
    if (state.q[i] < joint.position_min || state.q[i] > joint.position_max) {
      findings.add(Fault::joint_limit);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    finite &= std::isfinite(state.p_WB[k]) && std::isfinite(state.v_WB[k]) &&
              std::isfinite(state.w_WB_B[k]);
  }
  for (const double q : state.q_WB) finite &= std::isfinite(q);
  if (!finite) findings.add(Fault::non_finite);

  double ground = state.p_WB[2];
  for (int c = 0; c < model.contact_count(); ++c) {
    ground = std::min(ground, model.point(c).position[2]);
  }
  const bool low = model.contact_count() > 0 && robot_.standing_height > 0.0 &&
                   state.p_WB[2] - ground < robot_.height_limit * robot_.standing_height;
  const double upright = model.R_WB()[8];  // cos of the tilt
  if (low || upright < std::cos(robot_.tilt_limit) || sensors.body_contact)
    findings.add(Fault::fall);
  return findings;
}

SafetyFindings SafetyFilter::filter(hal::Commands& commands) noexcept {
  SafetyFindings findings;
  torque_step_ = 0.0;
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    double& tau = commands.tau[j];
    if (!std::isfinite(tau)) {
      tau = 0.0;
      findings.add(Fault::non_finite);
    }
    const double limit = robot_.joints[j].torque_limit;
    if (limit > 0.0 && std::abs(tau) >= limit) {
      tau = std::clamp(tau, -limit, limit);
      findings.add(Fault::torque_limit);
    }
    if (have_previous_) torque_step_ = std::max(torque_step_, std::abs(tau - previous_[j]));
    previous_[j] = tau;
  }
  have_previous_ = true;
  if (robot_.torque_step_limit > 0.0 && torque_step_ > robot_.torque_step_limit) {
    findings.add(Fault::torque_step);
  }
  return findings;
}

}  // namespace footfall::engine
