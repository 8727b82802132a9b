// Foot placement by constant time to velocity reversal, in closed form for a pendulum of constant
// height. Pure functions without state. Called by the engine when a state asks for a plan.
//
//   x_sw, xd_sw  = CoM at the switch, predicted with ω = √(g/h) about the stance foot
//   x_p = x_sw + coth(ω t')/ω · xd_sw + κ (x_sw − x_d)        per axis of the heading frame
//
// Source: [Kim16] eqs. (19), (21) with the sign of κ corrected (docs/notation.md E1; with the
// printed κ = +0.4 one eigenvalue of the step-to-step map is 1.28): the foot is placed beyond the
// CoM as seen from the goal.
#pragma once

#include <array>
#include <complex>

namespace footfall::behaviors {

// Parameters of the planner. Axis 0 is x (forward), 1 is y (left) of the heading frame.
struct FootPlannerSpec {
  std::array<double, 2> kappa{0.0, 0.0};     // -
  std::array<double, 2> reversal{0.2, 0.2};  // s, time to velocity reversal t'
  double width_offset = 0.0;                 // m, added to y, outward
  double goal_error_limit = 0.0;             // m per axis, limit of x_sw - x_d; 0: unlimited
  double reach_x = 0.0;                      // m from the stance foot; 0: unlimited
  double min_width = 0.0;                    // m, minimum lateral distance of the swing foot
  double max_width = 0.0;                    // m; 0: unlimited
  double gravity = 9.81;                     // m/s^2
  // [Kim16]'s swing-time extension: landing is delayed until the predicted lateral speed at the
  // switch reaches this; 0: off (it causes falls under actuator lag).
  double extension_speed = 0.0;  // m/s
  double extension_limit = 0.0;  // s, maximum delay
  double goal_speed = 0.0;       // m/s, approach speed after a jump of the goal; 0: at once
  double velocity_filter = 0.0;  // s, LIPM-predictive filter of the CoM velocity; 0: off
};

struct FootPlannerInput {
  std::array<double, 2> com{};      // m, world
  std::array<double, 2> com_vel{};  // m/s, world
  double com_height = 0.0;          // m above the stance foot
  std::array<double, 3> stance{};   // m, world, contact point
  double yaw = 0.0;                 // rad, heading
  std::array<double, 2> goal{};     // m, world
  double switch_in = 0.0;           // s until the support change
  double swing_side = 1.0;          // +1: the swing foot belongs on the left, -1: on the right
};

struct FootPlan {
  bool ok = false;                        // finite, within the validity of the pendulum model
  std::array<double, 3> target{};         // m, world, contact point of the swing foot
  std::array<double, 2> predicted_pos{};  // m, world: CoM at the switch
  std::array<double, 2> predicted_vel{};  // m/s, world
  double extension = 0.0;                 // s, requested by the swing-time rule
  bool clamped = false;                   // the target was moved to the closest reachable one
};

FootPlan plan_foot(const FootPlannerSpec& spec, const FootPlannerInput& input) noexcept;

// Eigenvalues of the step-to-step map A' of one axis, the one of larger modulus first; a conjugate
// pair where tr² < 4 det. Source: tr A' and det A' with E1 of docs/notation.md. Steps do not grow
// if no modulus exceeds 1: kappa >= 0, t' >= T/2 and (1 + kappa) tanh(ωT/2) tanh(ωt') <= 1.
std::array<std::complex<double>, 2> step_eigenvalues(double kappa, double reversal,
                                                     double step_time, double height,
                                                     double gravity) noexcept;

}  // namespace footfall::behaviors
