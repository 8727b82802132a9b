// Closed-form foot placement; see foot_planner.h.
#include "behaviors/planners/foot_planner.h"

#include <algorithm>
#include <cmath>

namespace footfall::behaviors {
namespace {

using Vector2 = std::array<double, 2>;

Vector2 to_heading(const Vector2& v, double c, double s) noexcept {
  return {c * v[0] + s * v[1], -s * v[0] + c * v[1]};
}
Vector2 to_world(const Vector2& v, double c, double s) noexcept {
  return {c * v[0] - s * v[1], s * v[0] + c * v[1]};
}

// Time after the switch until the lateral speed away from the stance foot reaches `speed`, for the
// pendulum y(t) = y C + ẏ/ω S: ẏ(t) = ẏ C + ω y S. 0 if it is already reached, or if the CoM will
// pass over the foot and never turn.
double time_to_speed(double y, double yd, double omega, double speed, double limit) noexcept {
  const double v = y >= 0.0 ? yd : -yd;
  if (v >= speed) return 0.0;
  const double a = 0.5 * (v + omega * std::abs(y));  // a e^{ωt} + b e^{-ωt} = speed
  const double b = 0.5 * (v - omega * std::abs(y));
  if (a <= 0.0) return 0.0;
  const double e = (speed + std::sqrt(std::max(0.0, speed * speed - 4.0 * a * b))) / (2.0 * a);
  return std::clamp(std::log(std::max(e, 1.0)) / omega, 0.0, limit);
}

}  // namespace

FootPlan plan_foot(const FootPlannerSpec& spec, const FootPlannerInput& in) noexcept {
  FootPlan plan;
  if (!(in.com_height > 0.05) || !(spec.gravity > 0.0)) return plan;
  const double c = std::cos(in.yaw);
  const double s = std::sin(in.yaw);
  const double omega = std::sqrt(spec.gravity / in.com_height);
  const Vector2 x = to_heading({in.com[0] - in.stance[0], in.com[1] - in.stance[1]}, c, s);
  const Vector2 v = to_heading(in.com_vel, c, s);
  const Vector2 goal = to_heading({in.goal[0] - in.stance[0], in.goal[1] - in.stance[1]}, c, s);

  double time = std::max(0.0, in.switch_in);
  const auto predict = [&](std::size_t k, double t) noexcept -> Vector2 {
    const double C = std::cosh(omega * t);
    const double S = std::sinh(omega * t);
    return {C * x[k] + S / omega * v[k], omega * S * x[k] + C * v[k]};
  };
  if (spec.extension_speed > 0.0) {
    const Vector2 lateral = predict(1, time);
    plan.extension =
        time_to_speed(lateral[0], lateral[1], omega, spec.extension_speed, spec.extension_limit);
    time += plan.extension;
  }

  Vector2 switch_pos{}, switch_vel{}, foot{};
  for (std::size_t k = 0; k < 2; ++k) {
    const Vector2 p = predict(k, time);
    switch_pos[k] = p[0];
    switch_vel[k] = p[1];
    double from_goal = p[0] - goal[k];
    if (spec.goal_error_limit > 0.0) {
      from_goal = std::clamp(from_goal, -spec.goal_error_limit, spec.goal_error_limit);
    }
    foot[k] =
        p[0] + p[1] / (omega * std::tanh(omega * spec.reversal[k])) + spec.kappa[k] * from_goal;
  }
  foot[1] += in.swing_side * spec.width_offset;

  const Vector2 wanted = foot;
  if (spec.reach_x > 0.0) foot[0] = std::clamp(foot[0], -spec.reach_x, spec.reach_x);
  double width = foot[1] * in.swing_side;
  if (spec.min_width > 0.0) width = std::max(width, spec.min_width);
  if (spec.max_width > 0.0) width = std::min(width, spec.max_width);
  foot[1] = width * in.swing_side;
  plan.clamped = foot != wanted;

  const Vector2 target = to_world(foot, c, s);
  const Vector2 pos = to_world(switch_pos, c, s);
  plan.target = {in.stance[0] + target[0], in.stance[1] + target[1], in.stance[2]};
  plan.predicted_pos = {in.stance[0] + pos[0], in.stance[1] + pos[1]};
  plan.predicted_vel = to_world(switch_vel, c, s);
  plan.ok = std::isfinite(plan.target[0]) && std::isfinite(plan.target[1]);
  return plan;
}

std::array<std::complex<double>, 2> step_eigenvalues(double kappa, double reversal,
                                                     double step_time, double height,
                                                     double gravity) noexcept {
  const double omega = std::sqrt(gravity / height);
  const double C = std::cosh(omega * step_time);
  const double S = std::sinh(omega * step_time);
  const double coth = 1.0 / std::tanh(omega * reversal);
  const double trace = 1.0 + kappa + (1.0 - kappa) * C - S * coth;
  const double det = -kappa + (1.0 + kappa) * C - S * coth;
  const std::complex<double> root = std::sqrt(std::complex<double>(0.25 * trace * trace - det));
  const std::complex<double> a = 0.5 * trace + root;
  const std::complex<double> b = 0.5 * trace - root;
  if (std::abs(a) >= std::abs(b)) return {a, b};
  return {b, a};
}

}  // namespace footfall::behaviors
