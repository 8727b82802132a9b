// Exact steps of a rotor between motor and spring; see series_elastic.h.
#include "hal/actuators/series_elastic.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace footfall::hal {
namespace {

// exp(A h) of A = [0 1; -k/J -b/J]. With s = b/2J and w^2 = k/J - s^2 it is
// e^{-s h} (C I + S (A + s I)), C = cos(w h), S = sin(w h)/w; hyperbolic for w^2 < 0.
void transition(double stiffness, double damping, double h, double (&phi)[4]) {
  const double s = 0.5 * damping;
  const double square = stiffness - s * s;
  const double w = std::sqrt(std::abs(square));
  const double angle = w * h;
  double c = 1.0, sine = h;
  if (angle > 1e-9) {
    c = square > 0.0 ? std::cos(angle) : std::cosh(angle);
    sine = (square > 0.0 ? std::sin(angle) : std::sinh(angle)) / w;
  }
  double decay = std::exp(-s * h);
  if (square < 0.0 && angle > 20.0) {  // e^{-sh} cosh(wh) overflows: e^{(w-s)h} is what is left
    decay = 1.0;
    c = 0.5 * std::exp((w - s) * h);
    sine = c / w;
  }
  phi[0] = decay * (c + sine * s);
  phi[1] = decay * sine;
  phi[2] = -decay * sine * stiffness;
  phi[3] = decay * (c - sine * s);
}

void require(bool good, const char* what) {
  if (!good) throw std::invalid_argument(std::string("series-elastic actuator: ") + what);
}

}  // namespace

SeriesElasticActuator::SeriesElasticActuator(const SeriesElasticParameters& parameters, double step)
    : parameters_(parameters), step_(step) {
  require(std::isfinite(parameters.spring) && parameters.spring > 0.0, "no spring");
  require(std::isfinite(parameters.rotor) && parameters.rotor > 0.0, "no rotor inertia");
  require(step > 0.0, "no step");
  require(parameters.viscous >= 0.0 && parameters.coulomb >= 0.0, "negative friction");
  transition(parameters.spring / parameters.rotor, parameters.viscous / parameters.rotor, step,
             phi_);
}

double SeriesElasticActuator::saturated(double motor_torque) const noexcept {
  constexpr double kFull = 0.8;  // of the speed: up to there the full torque is available
  const double most = parameters_.torque;
  double u = most > 0.0 ? std::clamp(motor_torque, -most, most) : motor_torque;
  const double limit = parameters_.speed;
  if (limit > 0.0 && u * state_.rate > 0.0) {
    const double left = (limit - std::abs(state_.rate)) / ((1.0 - kFull) * limit);
    u *= std::clamp(left, 0.0, 1.0);
  }
  return u;
}

SeriesElasticStep SeriesElasticActuator::advance(double motor_torque, double joint_rate) noexcept {
  const double k = parameters_.spring, b = parameters_.viscous;
  SeriesElasticStep done;
  done.motor_torque = saturated(motor_torque);
  // About the steady state of constant inputs: θ' = q', k (θ − q) = u − f − b q'.
  const double free = (done.motor_torque - b * joint_rate) / k;
  const double slip = state_.rate - joint_rate;
  const double rate_without = joint_rate + phi_[2] * (state_.deflection - free) + phi_[3] * slip;
  // θ' at the end is affine in f, with the slope phi_21/k < 0: f brings it to rest, or is at its
  // limit.
  const double slope = -phi_[2] / k;
  if (parameters_.coulomb > 0.0 && slope > 0.0) {
    const double f = std::clamp(rate_without / slope, -parameters_.coulomb, parameters_.coulomb);
    const double e1 = state_.deflection - free + f / k;
    const double angle = joint_rate * step_ + (phi_[0] - 1.0) * e1 + phi_[1] * slip;
    // In a step in which θ' changes its sign f would drive: it then begins with the next step. A
    // rotor at rest stays there, whatever the joint does: the mean torque that holds it moves it by
    // a third-order angle within the step.
    constexpr double kRest = 1e-12;  // rad/s
    if (f * angle >= 0.0 || std::abs(state_.rate) < kRest) done.friction_torque = f;
  }
  const double steady = free - done.friction_torque / k;
  const double e1 = state_.deflection - steady, e2 = slip;
  const double after1 = phi_[0] * e1 + phi_[1] * e2, after2 = phi_[2] * e1 + phi_[3] * e2;
  // ∫e dt = A^{-1} (e(h) − e(0)), A^{-1} = [−b/k −J/k; 1 0].
  const double d1 = after1 - e1, d2 = after2 - e2;
  const double integral1 = -(b * d1 + parameters_.rotor * d2) / k;
  done.spring_torque = k * (steady + integral1 / step_);
  done.motor_angle = joint_rate * step_ + d1;
  state_.deflection = steady + after1;
  state_.rate = joint_rate + after2;
  return done;
}

double SeriesElasticActuator::energy() const noexcept {
  return 0.5 * (parameters_.rotor * state_.rate * state_.rate +
                parameters_.spring * state_.deflection * state_.deflection);
}

}  // namespace footfall::hal
