// Closed form and frequency sweep; see passivity.h.
#include "hal/actuators/passivity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace footfall::hal {

std::complex<double> output_admittance(const TorqueLoopGains& gains,
                                       const SeriesElasticParameters& actuator, double delay,
                                       std::complex<double> s) {
  const std::complex<double> late = std::exp(-s * delay);
  const std::complex<double> outer = gains.p + gains.i / s;  // of the torque error, −τ_s
  const std::complex<double> rotor = actuator.rotor * s + actuator.viscous;
  if (gains.type == TorqueLoopGains::Type::cascade) {
    const std::complex<double> inner = gains.velocity_p + gains.velocity_i / s;
    return (1.0 + late * inner * outer) / (rotor + late * inner);
  }
  // u = −(P + I/s) τ_s − D (θ' or τ_s'/k) − Q (J s θ' + τ_s − u), Q = w/(s + w): with Q/(1 − Q) =
  // w/s the observer adds w/s (J s θ' + τ_s) and divides the law by 1 − Q.
  const double w = 2.0 * std::numbers::pi * gains.observer;
  const std::complex<double> share = 1.0 + w / s;  // 1/(1 − Q)
  const bool of_motor = gains.damps == TorqueLoopGains::Damping::motor;
  const std::complex<double> of_torque =
      share * (outer + (of_motor ? 0.0 : gains.damping * s / actuator.spring)) + w / s;
  const std::complex<double> of_rate =
      share * (of_motor ? gains.damping : 0.0) + w * actuator.rotor;
  return (1.0 + late * of_torque) / (rotor + late * of_rate);
}

std::complex<double> locked_response(const TorqueLoopGains& gains,
                                     const SeriesElasticParameters& actuator,
                                     std::complex<double> s) {
  const std::complex<double> outer = gains.p + gains.i / s;
  const std::complex<double> rotor =
      (actuator.rotor * s + actuator.viscous) * s / actuator.spring + 1.0;
  const std::complex<double> turn = s / actuator.spring;  // of θ' = q' + τ_s'/k by τ_s
  if (gains.type == TorqueLoopGains::Type::cascade) {
    const std::complex<double> inner = gains.velocity_p + gains.velocity_i / s;
    return inner * outer / (rotor + inner * (outer + turn));
  }
  const double w = 2.0 * std::numbers::pi * gains.observer;
  const std::complex<double> share = 1.0 + w / s;
  const std::complex<double> found = w / s * (actuator.rotor * s * turn + 1.0);
  return share * (gains.forward + outer) / (rotor + share * (outer + gains.damping * turn) + found);
}

double loop_bandwidth(const TorqueLoopGains& gains, const SeriesElasticParameters& actuator) {
  constexpr double kFrom = 0.1, kTo = 1000.0, kRatio = 1.005;  // Hz
  const auto size = [&](double hertz) {
    return std::abs(locked_response(gains, actuator, {0.0, 2.0 * std::numbers::pi * hertz}));
  };
  const double least = size(kFrom) / std::numbers::sqrt2;
  double hertz = kFrom;
  while (hertz < kTo && size(hertz) > least) hertz *= kRatio;
  return std::min(hertz, kTo);
}

double passivity_margin(const TorqueLoopGains& gains, const SeriesElasticParameters& actuator) {
  const double j = actuator.rotor, b = actuator.viscous;
  const auto relative = [](double good, double bad) {
    return good > 0.0 ? (good - bad) / good : good - bad;
  };
  if (gains.type == TorqueLoopGains::Type::direct) {
    const bool of_motor = gains.damps == TorqueLoopGains::Damping::motor;
    return relative((1.0 + gains.p) * (b + (of_motor ? gains.damping : 0.0)), gains.i * j);
  }
  const double at_high = relative((1.0 + gains.velocity_p * gains.p) * (b + gains.velocity_p),
                                  j * (gains.velocity_p * gains.i + gains.velocity_i * gains.p));
  if (gains.velocity_i == 0.0) return at_high;
  return std::min(at_high, relative(gains.velocity_i * gains.p, gains.i * b));
}

double least_admittance(const TorqueLoopGains& gains, const SeriesElasticParameters& actuator,
                        double delay, double from, double to, int points) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < points; ++k) {
    const double part = points > 1 ? static_cast<double>(k) / (points - 1) : 0.0;
    const double w = 2.0 * std::numbers::pi * from * std::pow(to / from, part);
    least = std::min(least, output_admittance(gains, actuator, delay, {0.0, w}).real());
  }
  return least;
}

}  // namespace footfall::hal
