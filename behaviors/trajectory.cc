// Trajectory segments; see trajectory.h.
#include "behaviors/trajectory.h"

#include <cmath>
#include <numbers>

namespace footfall::behaviors {
namespace {

// Coefficients in s of the cubic with positions x0, x1 and velocities v0, v1 (per unit of s).
std::array<double, 6> cubic(double x0, double v0, double x1, double v1) noexcept {
  const double d = x1 - x0;
  return {x0, v0, 3.0 * d - 2.0 * v0 - v1, -2.0 * d + v0 + v1, 0.0, 0.0};
}

// The quintic with acceleration a0 at the start and 0 at the end (per unit of s squared).
std::array<double, 6> quintic(double x0, double v0, double a0, double x1, double v1) noexcept {
  const double d = x1 - x0;
  return {x0,
          v0,
          0.5 * a0,
          10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0,
          -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0,
          6.0 * d - 3.0 * v0 - 3.0 * v1 - 0.5 * a0};
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
    g.c = quintic(start.pos, start.vel * T, start.acc * T * T, to, end_velocity * T);
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
  const auto& c = g.c;
  return {c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5])))),
          (c[1] + s * (2.0 * c[2] + s * (3.0 * c[3] + s * (4.0 * c[4] + s * 5.0 * c[5])))) / T,
          (2.0 * c[2] + s * (6.0 * c[3] + s * (12.0 * c[4] + s * 20.0 * c[5]))) / (T * T)};
}

}  // namespace footfall::behaviors
