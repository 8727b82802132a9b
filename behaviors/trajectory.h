// Reference trajectories of one axis, from the value at entry so that nothing jumps. Pure functions
// of the time since the start; allocation-free.
#pragma once

#include <array>
#include <cstdint>

namespace footfall::behaviors {

enum class Shape : std::uint8_t { hold, polynomial3, polynomial5, cosine, minimum_jerk };

// Position, velocity and acceleration of one axis, SI.
struct Motion {
  double pos = 0.0;
  double vel = 0.0;
  double acc = 0.0;
};

// One segment: from `start` to `to` within `duration`, arriving with `end_velocity`, which is kept
// on afterwards.
//   polynomial3:   cubic with the velocity at both ends
//   polynomial5:   quintic with velocity and acceleration at the start, acceleration 0 at the end
//   minimum_jerk:  the same quintic (it minimises jerk between these ends)
//   cosine:        x0 + (x1 - x0)(1 - cos(pi s))/2; a velocity at the start dies out as s(1 - s)^2
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

}  // namespace footfall::behaviors
