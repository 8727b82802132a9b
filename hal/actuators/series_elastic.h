// A series-elastic actuator: a motor whose rotor drives the joint through a spring. The rotor is
// its state; the joint belongs to the plant (a simulator, or the stub's inertia).
//
//   J θ'' = u − b θ' − f(θ') − k (θ − q),     τ_s = k (θ − q)                    (hume-facts 6)
//
// θ rotor angle, q joint angle, u motor torque, J reflected rotor inertia, b viscous and f Coulomb
// friction, all on the joint's side of the gear. No allocation; safe for the tick.
#pragma once

namespace footfall::hal {

// SI; on the joint's side of the gear.
struct SeriesElasticParameters {
  double spring = 0.0;   // k, N m/rad, above 0
  double rotor = 0.0;    // J, kg m^2, above 0
  double viscous = 0.0;  // b, N m s/rad
  double coulomb = 0.0;  // largest |f|, N m
  double torque = 0.0;   // largest |u|, N m; 0: unlimited
  double speed = 0.0;    // |θ'| from which no u drives any faster, rad/s; 0: unlimited
};

struct SeriesElasticState {
  double deflection = 0.0;  // θ − q, rad
  double rate = 0.0;        // θ', rad/s
};

// What one step did: means over it, and energies for a balance. N m, J.
struct SeriesElasticStep {
  double motor_torque = 0.0;     // u after saturation
  double friction_torque = 0.0;  // f, Coulomb
  double spring_torque = 0.0;    // mean of τ_s: its product with the step is the exact impulse
  double motor_angle = 0.0;      // ∫θ' dt, rad
};

class SeriesElasticActuator {
 public:
  // Steps of a fixed duration, s. Throws std::invalid_argument for a spring, rotor or step that is
  // not above 0, and for negative friction.
  SeriesElasticActuator(const SeriesElasticParameters& parameters, double step);

  // Advances by one step with a constant motor torque and a constant joint velocity (rad/s). Exact
  // but for Coulomb friction, which is constant over the step (implicit: it never drives the rotor
  // past rest), so that no spring is too stiff and no rotor too light for the step.
  SeriesElasticStep advance(double motor_torque, double joint_rate) noexcept;

  // u as the motor can produce it at the present speed.
  double saturated(double motor_torque) const noexcept;

  const SeriesElasticState& state() const noexcept { return state_; }
  void set_state(const SeriesElasticState& state) noexcept { state_ = state; }
  // τ_s at this moment, N m.
  double spring_torque() const noexcept { return parameters_.spring * state_.deflection; }
  // Kinetic plus elastic energy, J.
  double energy() const noexcept;
  const SeriesElasticParameters& parameters() const noexcept { return parameters_; }

 private:
  SeriesElasticParameters parameters_;
  SeriesElasticState state_;
  double step_;
  // exp(A h) of (θ − q, θ' − q') about their steady values, A = [0 1; −k/J −b/J]; row-major.
  double phi_[4] = {1.0, 0.0, 0.0, 1.0};
};

}  // namespace footfall::hal
