// Intervals in which a motor moves in one direction, and modulating functions in them.
#pragma once

#include <span>
#include <vector>

namespace footfall::lab {

// Consecutive samples, both ends included.
struct Interval {
  int first = 0, last = 0;
  int direction = 0;  // +1 or -1
  int length() const noexcept { return last - first + 1; }
};

// Step of an encoder: the smallest difference between successive values; 0 if all are equal.
double encoder_step(std::span<const double> values);

// Where the velocity has one sign and is clearly not 0. It is a least-squares slope over
// 2 kSlopeReach + 1 samples, and the ends keep that reach away from where it is small.
std::vector<Interval> moving_intervals(std::span<const double> angle, double period);
inline constexpr int kSlopeReach = 4;  // samples

// φ(x) = (4x(1 − x))^4, or that times (1 − 2x), on [0, 1]; 0 outside.
struct Modulation {
  double value = 0.0, first = 0.0, second = 0.0;  // φ, dφ/dx, d²φ/dx²
};
Modulation modulation(double x, bool odd) noexcept;

// Windows of at most `longest` samples that cover an interval, each half over the next.
std::vector<Interval> windows_of(const Interval& interval, int longest);

}  // namespace footfall::lab
