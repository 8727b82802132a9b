// Checks and clamps; see safety.h.
#include "engine/tick/safety.h"

#include <algorithm>
#include <cmath>

#include "engine/tick/fall.h"
#include "tasks/solver/wbosc.h"

namespace footfall::engine {

using core::Fault;

namespace {

// As near to `wanted` as a step of `bound` from `previous` comes; the rounded difference of the two
// is not beyond it either.
double limited_step(double previous, double wanted, double bound) noexcept {
  double tau = std::clamp(wanted, previous - bound, previous + bound);
  while (std::abs(tau - previous) > bound) tau = std::nextafter(tau, previous);
  return tau;
}

}  // namespace

SafetyFilter::SafetyFilter(const model::RobotDescription& robot) : robot_(robot) {}

void SafetyFilter::check_swings(const TickStart& tick, FaultFindings& findings) noexcept {
  for (std::size_t c = 0; c < robot_.contacts.size(); ++c) {
    air_ticks_[c] = tick.contact[c] ? 0 : air_ticks_[c] + 1;
    const double time = static_cast<double>(air_ticks_[c]) * robot_.period_s();
    if (!tick.stepping || time <= robot_.swing_limit) continue;
    findings.add(Fault::swing_too_long, {static_cast<int>(c), time, time - robot_.swing_limit});
  }
}

FaultFindings SafetyFilter::check_state(const hal::Sensors& sensors, const TickStart& tick,
                                        const model::ControlModel& model) noexcept {
  FaultFindings findings;
  if (!tick.fresh || tick.sensed.joints_stale) findings.add(Fault::sensor_stale);
  if (!tick.estimated) findings.add(Fault::no_estimate);
  check_swings(tick, findings);
  if (sensors.backend_fault) findings.add(Fault::simulator_warning);
  if (tick.sensed.imu_stale) findings.add(Fault::imu_stale);
  if (tick.sensed.mocap_stale) findings.add(Fault::mocap_stale);
  if (tick.sensed.clock) findings.add(Fault::sensor_clock);
  if (tick.sensed.infinite) findings.add(Fault::sensor_nan);
  const model::State& state = model.state();
  bool finite = true;
  for (int j = 0; j < model.joint_count(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    finite &= std::isfinite(state.q[i]) && std::isfinite(state.qd[i]);
    const model::JointDescription& joint = robot_.joints[i];
    if (state.q[i] < joint.position_min || state.q[i] > joint.position_max) {
      const double excess =
          std::max(joint.position_min - state.q[i], state.q[i] - joint.position_max);
      findings.add(Fault::joint_limit, {j, state.q[i], excess});
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    finite &= std::isfinite(state.p_WB[k]) && std::isfinite(state.v_WB[k]) &&
              std::isfinite(state.w_WB_B[k]);
  }
  for (const double q : state.q_WB) finite &= std::isfinite(q);
  if (!finite) findings.add(Fault::non_finite);

  if (judge_fall(robot_, sensors, model).fallen()) findings.add(Fault::fall);
  return findings;
}

FaultFindings SafetyFilter::filter(hal::Commands& commands, const hal::Sensors& sensors,
                                   bool limit_steps) noexcept {
  FaultFindings findings;
  torque_step_ = 0.0;
  held_back_ = false;
  bool finite = true;
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) finite &= std::isfinite(commands.tau[j]);
  if (!finite) findings.add(Fault::non_finite);
  // What is not finite is let go at once.
  const bool bounded = limit_steps && have_previous_ && finite && robot_.torque_step_limit > 0.0;
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    double& tau = commands.tau[j];
    if (!finite) tau = 0.0;
    double limit = robot_.joints[j].torque_limit;
    const double measured =
        std::copysign(sensors.tau[j], sensors.tau[j] * tau);  // along the command
    if (robot_.command_limit > 1.0 && measured < limit) limit *= robot_.command_limit;
    if (limit > 0.0 && std::abs(tau) >= limit) {
      findings.add(Fault::torque_limit, {static_cast<int>(j), tau, std::abs(tau) - limit});
      tau = tasks::within_limit(tau, limit);
    }
    if (bounded && std::abs(tau - previous_[j]) > robot_.torque_step_limit) {
      tau = limited_step(previous_[j], tau, robot_.torque_step_limit);
      held_back_ = true;
    }
    const double step = have_previous_ ? tau - previous_[j] : 0.0;
    torque_step_ = std::max(torque_step_, std::abs(step));
    const double excess = std::abs(step) - robot_.torque_step_limit;
    if (robot_.torque_step_limit > 0.0 && excess > 0.0) {
      findings.add(Fault::torque_step, {static_cast<int>(j), step, excess});
    }
    previous_[j] = tau;
  }
  have_previous_ = true;
  return findings;
}

}  // namespace footfall::engine
