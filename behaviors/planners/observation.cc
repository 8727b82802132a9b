// CoM velocity filter, goal approach and the input of a plan; see observation.h.
#include "behaviors/planners/observation.h"

#include <algorithm>
#include <cmath>

namespace footfall::behaviors {
namespace {

void approach_goal(PlannerObservation& seen, const FootPlannerSpec& spec,
                   const PendulumMeasurement& measured, const std::array<double, 2>& wanted,
                   double period) noexcept {
  std::array<double, 2>& goal = seen.goal;
  if (!seen.primed) goal = {measured.com[0], measured.com[1]};
  const double distance = std::hypot(wanted[0] - goal[0], wanted[1] - goal[1]);
  const double step = spec.goal_speed * period;
  if (!(spec.goal_speed > 0.0) || distance <= step) {
    goal = wanted;
    return;
  }
  for (std::size_t k = 0; k < 2; ++k) goal[k] += step / distance * (wanted[k] - goal[k]);
}

void filter_velocity(PlannerObservation& seen, const FootPlannerSpec& spec,
                     const PendulumMeasurement& measured, double period) noexcept {
  const double tau = spec.velocity_filter;
  std::array<double, 2>& v = seen.velocity;
  const bool valid = std::isfinite(v[0]) && std::isfinite(v[1]);
  if (!seen.primed || !(tau > 0.0) || !measured.supported || !valid) {
    v = {measured.com_vel[0], measured.com_vel[1]};
    return;
  }
  const double height = std::max(0.1, measured.com[2] - measured.support[2]);
  for (std::size_t k = 0; k < 2; ++k) {
    v[k] += period * (spec.gravity / height * (measured.com[k] - measured.support[k]) +
                      (measured.com_vel[k] - v[k]) / tau);
  }
}

}  // namespace

void observe(PlannerObservation& seen, const FootPlannerSpec& spec,
             const PendulumMeasurement& measured, const std::array<double, 2>& wanted,
             double period) noexcept {
  approach_goal(seen, spec, measured, wanted, period);
  filter_velocity(seen, spec, measured, period);
  seen.primed = true;
}

FootPlannerInput make_input(const PlannerObservation& seen, const std::array<double, 3>& com,
                            const std::array<double, 3>& stance, double yaw, double swing_side,
                            double switch_in) noexcept {
  FootPlannerInput input;
  input.com = {com[0], com[1]};
  input.com_vel = seen.velocity;
  input.com_height = com[2] - stance[2];
  input.stance = stance;
  input.yaw = yaw;
  input.goal = seen.goal;
  input.switch_in = switch_in;
  input.swing_side = swing_side;
  return input;
}

}  // namespace footfall::behaviors
