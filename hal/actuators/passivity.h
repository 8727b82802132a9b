// Frequency response of a torque-controlled series-elastic actuator, and passivity at its output:
// whether it can only take energy from what it is coupled to (zero torque reference). With a(s) =
// −θ'/τ_s the port is passive if Re a(jω) ≥ 0 at all ω, since the spring adds s/k. Load time only.
#pragma once

#include <complex>

#include "hal/actuators/series_elastic.h"
#include "hal/actuators/torque_loop.h"

namespace footfall::hal {

// τ_s/τ_d with the output locked, without delay; continuous time.
std::complex<double> locked_response(const TorqueLoopGains& gains,
                                     const SeriesElasticParameters& actuator,
                                     std::complex<double> s);
// Hz; the first frequency from 0.1 Hz to 1 kHz at which that is 3 dB below its value at 0.1 Hz, to
// 0.5 %; 1 kHz if there is none.
double loop_bandwidth(const TorqueLoopGains& gains, const SeriesElasticParameters& actuator);

// a(s), 1/(N m s/rad); `delay`: s, from the measurement to the motor torque.
std::complex<double> output_admittance(const TorqueLoopGains& gains,
                                       const SeriesElasticParameters& actuator, double delay,
                                       std::complex<double> s);

// The closed form, without delay and observer; 0 or more: passive. For `cascade`, with b for
// viscous friction,
//   (1 + P_v P_t)(b + P_v) − J (P_v I_t + I_v P_t)  and  I_v (I_v P_t − I_t b)
// must be 0 or more (hume-facts 6 for b = 0); for `direct` (1 + P)(b + D) − I J, D that on θ' only.
// The smaller one, each relative to its positive part.
double passivity_margin(const TorqueLoopGains& gains, const SeriesElasticParameters& actuator);

// The least Re a(jω) of a sweep of `points` frequencies from `from` to `to`, Hz, spaced by ratio.
double least_admittance(const TorqueLoopGains& gains, const SeriesElasticParameters& actuator,
                        double delay, double from, double to, int points);

}  // namespace footfall::hal
