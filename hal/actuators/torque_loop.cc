// Cascaded and direct torque control; see torque_loop.h.
#include "hal/actuators/torque_loop.h"

#include <cmath>
#include <numbers>

namespace footfall::hal {

TorqueLoop::TorqueLoop(const TorqueLoopGains& gains, double step, double rotor)
    : gains_(gains), step_(step), rotor_(rotor), decay_(std::exp(-step / kBlend)) {}

double TorqueLoop::bandwidth() const noexcept {
  const bool direct = gains_.type == TorqueLoopGains::Type::direct;
  return direct ? 2.0 * std::numbers::pi * gains_.observer : 0.0;
}

double TorqueLoop::disturbance(double motor_rate) const noexcept {
  return bandwidth() * (rotor_ * motor_rate - momentum_);
}

double TorqueLoop::law(const TorqueLoopInput& input) const noexcept {
  const double error = input.reference - input.torque;
  const double outer = gains_.p * error + torque_integral_;
  if (gains_.type == TorqueLoopGains::Type::cascade) {
    return gains_.velocity_p * (outer - input.motor_rate) + velocity_integral_;
  }
  const bool of_motor = gains_.damps == TorqueLoopGains::Damping::motor;
  const double rate = of_motor ? input.motor_rate : input.spring_rate;
  return gains_.forward * input.reference + outer - gains_.damping * rate -
         disturbance(input.motor_rate);
}

double TorqueLoop::ask(const TorqueLoopInput& input) const noexcept { return law(input) + offset_; }

void TorqueLoop::settle(const TorqueLoopInput& input, double asked, double given) noexcept {
  const double excess = asked - given;
  const double error = input.reference - input.torque;
  if (gains_.type == TorqueLoopGains::Type::cascade) {
    const double slip = gains_.p * error + torque_integral_ - input.motor_rate;
    if (excess * slip <= 0.0) velocity_integral_ += gains_.velocity_i * slip * step_;
  }
  if (excess * error <= 0.0) torque_integral_ += gains_.i * error * step_;
  momentum_ += (given - input.torque + disturbance(input.motor_rate)) * step_;
  offset_ *= decay_;
}

void TorqueLoop::change(const TorqueLoopGains& gains, const TorqueLoopInput& now) noexcept {
  const double before = law(now) + offset_;
  const double found = disturbance(now.motor_rate);
  if (gains.type != gains_.type || gains.i == 0.0) torque_integral_ = 0.0;
  if (gains.type != gains_.type || gains.velocity_i == 0.0) velocity_integral_ = 0.0;
  gains_ = gains;
  const double w = bandwidth();  // the estimate goes on from where it was
  momentum_ = rotor_ * now.motor_rate - (w > 0.0 ? found / w : 0.0);
  offset_ = before - law(now);
}

void TorqueLoop::reset() noexcept {
  torque_integral_ = velocity_integral_ = offset_ = momentum_ = 0.0;
}

}  // namespace footfall::hal
