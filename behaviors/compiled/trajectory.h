// Reference trajectories of one axis, which start at the value at entry, so that the reference is
// continuous. Pure functions of the time since the start; allocation-free.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace footfall::behaviors {

enum class Shape : std::uint8_t {
  hold,
  polynomial3,
  polynomial5,
  cosine,
  minimum_jerk,
  // Consist of more than one segment; their segment, a minimum_jerk or hold, is
  ellipse,    // the centre's path
  waypoints,  // unused
  surface,    // the height above the surface
};

// Position, velocity and acceleration of one axis, SI.
struct Motion {
  double pos = 0.0;
  double vel = 0.0;
  double acc = 0.0;
};

// One segment: from `start` to `to` within `duration`, ending with `end_velocity`, which is kept
// afterwards.
//   polynomial3:   cubic with given velocities at both ends
//   polynomial5:   quintic with velocity and acceleration at the start, acceleration 0 at the end
//   minimum_jerk:  the same quintic (it minimises jerk between these ends)
//   cosine:        x0 + (x1 - x0)(1 - cos(pi s))/2; an initial velocity decays as s(1 - s)^2
//   hold:          stays at the start, velocity 0
struct Segment {
  Shape shape = Shape::hold;
  double duration = 0.0;  // s
  double to = 0.0;
  double end_velocity = 0.0;
  Motion start;
  std::array<double, 6> c{};  // polynomial in s = t/duration
};

Segment make_segment(Shape shape, const Motion& start, double to, double end_velocity,
                     double duration) noexcept;
Motion sample(const Segment& segment, double t) noexcept;
// The same motion, expressed from an origin that is `by` lower.
void shift(Segment& segment, double by) noexcept;

// Position and time of a point to pass.
struct Knot {
  double time = 0.0;  // s since the start
  double pos = 0.0;
  double vel = 0.0;
  double acc = 0.0;
};

// Sets velocity and acceleration at the inner knots to those of the cubic spline through all knots
// with the given end velocities (de Boor 1978, ch. IV, complete spline). Times must increase.
void fit_knots(std::span<Knot> knots) noexcept;
// Quintics between the knots: position, velocity and acceleration are continuous everywhere. The
// last velocity is kept after the end. At least one knot.
Motion sample_knots(std::span<const Knot> knots, double t) noexcept;

// One axis of an ellipse that grows from zero: g(t/ramp) radius cos(angle), with g the minimum-jerk
// step from 0 to 1. rate: of the angle, rad/s; t: s since the start.
Motion sample_ellipse(double radius, double angle, double rate, double ramp, double t) noexcept;

}  // namespace footfall::behaviors
