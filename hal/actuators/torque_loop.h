// The torque loop of a series-elastic actuator: from a torque reference to a motor torque, once an
// inner step. Two laws, which the literature's gains mix up:
//
//   cascade   ω_r = P_t e + I_t ∫e,   u = P_v (ω_r − θ') + I_v ∫(ω_r − θ')          (Vallery 2007)
//   direct    u = F τ_d + P e + I ∫e − D (θ' or θ' − q') − r
//
// e = τ_d − τ_s; integrals by Euler's forward rule. P_t in rad/s per N m, I_t in rad/s^2 per N m
// (Table I with the corrected units, erratum E19); P_v in N m s/rad, I_v in N m/rad; F, P plain
// numbers; I in 1/s; D in N m s/rad. r: the observer's estimate of what disturbs the rotor (N m, in
// the direction of u), from its momentum: r' = w (J θ'' − u + τ_s − r). No allocation; safe for the
// tick.
#pragma once

#include "hal/torque_loop_gains.h"

namespace footfall::hal {

struct TorqueLoopInput {
  double reference = 0.0;    // τ_d, N m
  double torque = 0.0;       // τ_s as measured, N m
  double motor_rate = 0.0;   // θ' as measured, rad/s
  double spring_rate = 0.0;  // θ' − q' as measured, rad/s
};

class TorqueLoop {
 public:
  // rotor: J, kg m^2, as the loop knows it; only the observer needs it.
  TorqueLoop(const TorqueLoopGains& gains, double step, double rotor = 0.0);

  // The motor torque for which the law asks, N m.
  double ask(const TorqueLoopInput& input) const noexcept;
  // Ends the step: `given` is what of `asked` the motor could produce. Integrals stop where they
  // would only ask for more than that.
  void settle(const TorqueLoopInput& input, double asked, double given) noexcept;

  // Other gains from the next step on, for which the motor torque is the same with the same input
  // (bumpless transfer): the difference is added, and decays with the time constant kBlend.
  void change(const TorqueLoopGains& gains, const TorqueLoopInput& now) noexcept;
  void reset() noexcept;
  static constexpr double kBlend = 0.02;  // s

  const TorqueLoopGains& gains() const noexcept { return gains_; }

 private:
  double law(const TorqueLoopInput& input) const noexcept;
  double bandwidth() const noexcept;  // of the observer, rad/s
  double disturbance(double motor_rate) const noexcept;

  TorqueLoopGains gains_;
  double step_, rotor_;
  double momentum_ = 0.0;           // J θ' as it would be with r as the only disturbance, N m s
  double torque_integral_ = 0.0;    // of e times its gain: in rad/s (cascade) or N m (direct)
  double velocity_integral_ = 0.0;  // N m
  double offset_ = 0.0;             // N m, what is left of a change of gains
  double decay_;                    // of it, by step
};

}  // namespace footfall::hal
