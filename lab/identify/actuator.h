// Identifies a series-elastic actuator from what a log has of it: spring, rotor, friction.
//
//   J θ'' + b θ' + f sign(θ') + k (θ − q) + c = u             (hal/actuators/series_elastic.h)
//
// No measured quantity is differentiated. The motor moves in one direction from one reversal to the
// next; with a smooth φ that vanishes with φ' outside of an interval between two reversals,
// integration by parts gives one equation that is linear in the parameters, in which the sign of θ'
// is a constant and stiction has no part:
//
//   J ∫φ''θ − b ∫φ'θ ± f ∫φ + k ∫φ (θ − q) + c ∫φ = ∫φ u
//
// docs/identify.md has the derivation. Pure functions; after a run.
#pragma once

#include <string_view>
#include <vector>

namespace footfall::lab {

// One joint, one value a tick, as logged.
struct ActuatorRecord {
  double period = 0.0;          // s, of a tick
  double drive_step = 0.0;      // s: the encoders were sampled this long before the end of the tick
  double nominal_spring = 0.0;  // N m/rad, with which the drive makes a torque of the deflection
  std::vector<double> torque;   // nominal spring times measured deflection, N m
  std::vector<double> motor;    // θ by its encoder, rad
  std::vector<double> motor_torque;  // u, N m, mean over the last tick
  // First moment of u about the middle of that tick, over its duration (N m s), where the loop's
  // law is known: a reference that is held for a tick makes steps in u. Empty: u has none.
  std::vector<double> moment;
};

struct Estimate {
  double value = 0.0;
  double error = 0.0;  // standard error
};

enum class Richness {
  good,
  poor,      // the parameters' effects resemble each other too much
  too_slow,  // hardly any time between reversals in which the motor moves
  still,     // the motor did not move
  absurd,    // a spring, inertia or friction is negative by more than its error
};
std::string_view name_of(Richness richness) noexcept;

struct ActuatorEstimate {
  Richness richness = Richness::still;
  double travel = 0.0;     // rad, range of the motor angle
  int equations = 0;       // rows of the regression
  double used = 0.0;       // s, in which the motor moved in one direction for long enough
  double condition = 0.0;  // of the regression with columns of unit length
  double residual = 0.0;   // N m, rms, of the means that the rows are
  // Valid if richness is `good` or `poor`. SI.
  Estimate spring, rotor, viscous, coulomb;
  Estimate offset;  // c: what acts on the rotor all the time
};

// Above this condition number the excitation is poor.
inline constexpr double kLargestCondition = 50.0;

ActuatorEstimate identify_actuator(const ActuatorRecord& record);

}  // namespace footfall::lab
