// Trajectory segments; see trajectory.h.
#include "behaviors/compiled/trajectory.h"

#include <cmath>
#include <numbers>

namespace footfall::behaviors {
namespace {

// Coefficients in s of the cubic with positions x0, x1 and velocities v0, v1 (per unit of s).
std::array<double, 6> cubic(double x0, double v0, double x1, double v1) noexcept {
  const double d = x1 - x0;
  return {x0, v0, 3.0 * d - 2.0 * v0 - v1, -2.0 * d + v0 + v1, 0.0, 0.0};
}

// The quintic with position, velocity and acceleration at both ends (per unit of s).
std::array<double, 6> quintic(const Motion& from, const Motion& to) noexcept {
  const double d = to.pos - from.pos;
  const double v0 = from.vel, a0 = from.acc, v1 = to.vel, a1 = to.acc;
  return {from.pos,
          v0,
          0.5 * a0,
          10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1,
          -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1,
          6.0 * d - 3.0 * v0 - 3.0 * v1 - 0.5 * a0 + 0.5 * a1};
}

// A polynomial in s = t/T and its derivatives in t.
Motion sample_polynomial(const std::array<double, 6>& c, double s, double T) noexcept {
  return {c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5])))),
          (c[1] + s * (2.0 * c[2] + s * (3.0 * c[3] + s * (4.0 * c[4] + s * 5.0 * c[5])))) / T,
          (2.0 * c[2] + s * (6.0 * c[3] + s * (12.0 * c[4] + s * 20.0 * c[5]))) / (T * T)};
}

Motion sample_cosine(const Segment& g, double s) noexcept {
  const double T = g.duration, d = g.to - g.start.pos, v = g.start.vel;
  const double pi = std::numbers::pi;
  const double r = 1.0 - s;
  return {g.start.pos + 0.5 * d * (1.0 - std::cos(pi * s)) + v * T * s * r * r,
          0.5 * d * pi / T * std::sin(pi * s) + v * r * (r - 2.0 * s),
          0.5 * d * pi * pi / (T * T) * std::cos(pi * s) + v / T * (6.0 * s - 4.0)};
}

}  // namespace

Segment make_segment(Shape shape, const Motion& start, double to, double end_velocity,
                     double duration) noexcept {
  Segment g{shape, duration, to, end_velocity, start, {}};
  const double T = duration;
  if (shape == Shape::polynomial3) {
    g.c = cubic(start.pos, start.vel * T, to, end_velocity * T);
  } else if (shape == Shape::polynomial5 || shape == Shape::minimum_jerk) {
    g.c = quintic({start.pos, start.vel * T, start.acc * T * T}, {to, end_velocity * T, 0.0});
  }
  return g;
}

Motion sample(const Segment& g, double t) noexcept {
  if (g.shape == Shape::hold) return {g.start.pos, 0.0, 0.0};
  if (!(t < g.duration)) {
    return {g.to + g.end_velocity * (t - g.duration), g.end_velocity, 0.0};
  }
  const double T = g.duration, s = t / T;
  if (g.shape == Shape::cosine) return sample_cosine(g, s);
  return sample_polynomial(g.c, s, T);
}

void shift(Segment& g, double by) noexcept {
  g.start.pos += by;
  g.to += by;
  g.c[0] += by;
}

// The spline's second derivative is continuous: a tridiagonal system in the inner velocities,
// solved by forward elimination. `acc` temporarily holds the factors.
void fit_knots(std::span<Knot> k) noexcept {
  if (k.size() < 3) return;
  const std::size_t last = k.size() - 1;
  const auto inverse = [&](std::size_t i) { return 1.0 / (k[i + 1].time - k[i].time); };
  const auto slope = [&](std::size_t i) { return (k[i + 1].pos - k[i].pos) * inverse(i); };
  const double start_acc = k[0].acc;
  k[0].acc = 0.0;
  for (std::size_t i = 1; i < last; ++i) {
    const double a = inverse(i - 1), c = inverse(i);
    const double pivot = 2.0 * (a + c) - a * k[i - 1].acc;
    const double right = 3.0 * (a * slope(i - 1) + c * slope(i));
    k[i].acc = c / pivot;
    k[i].vel = (right - a * k[i - 1].vel) / pivot;
  }
  for (std::size_t i = last - 1; i >= 1; --i) k[i].vel -= k[i].acc * k[i + 1].vel;
  for (std::size_t i = 1; i < last; ++i) {
    k[i].acc = inverse(i) * (6.0 * slope(i) - 4.0 * k[i].vel - 2.0 * k[i + 1].vel);
  }
  k[0].acc = start_acc;
}

Motion sample_knots(std::span<const Knot> k, double t) noexcept {
  const Knot& last = k.back();
  if (!(t < last.time)) return {last.pos + last.vel * (t - last.time), last.vel, 0.0};
  std::size_t i = 0;
  while (i + 2 < k.size() && t >= k[i + 1].time) ++i;
  const double T = k[i + 1].time - k[i].time;
  const auto c = quintic({k[i].pos, k[i].vel * T, k[i].acc * T * T},
                         {k[i + 1].pos, k[i + 1].vel * T, k[i + 1].acc * T * T});
  return sample_polynomial(c, (t - k[i].time) / T, T);
}

Motion sample_ellipse(double radius, double angle, double rate, double ramp, double t) noexcept {
  const Motion g = sample(make_segment(Shape::minimum_jerk, {}, 1.0, 0.0, ramp), t);
  const double x = radius * std::cos(angle), y = radius * rate * std::sin(angle);
  return {g.pos * x, g.vel * x - g.pos * y, g.acc * x - 2.0 * g.vel * y - g.pos * rate * rate * x};
}

}  // namespace footfall::behaviors
