// Reversals of a motor and modulating functions; see windows.h.
#include "lab/identify/windows.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace footfall::lab {
namespace {

// The slope of a straight line through 2 kSlopeReach + 1 samples, by sample; 0 at the ends.
std::vector<double> slopes(std::span<const double> angle, double period) {
  const int count = static_cast<int>(angle.size());
  double squares = 0.0;
  for (int i = 1; i <= kSlopeReach; ++i) squares += 2.0 * i * i;
  std::vector<double> out(angle.size(), 0.0);
  for (int k = kSlopeReach; k + kSlopeReach < count; ++k) {
    double sum = 0.0;
    for (int i = 1; i <= kSlopeReach; ++i) {
      sum += i * (angle[at(k + i)] - angle[at(k - i)]);
    }
    out[at(k)] = sum / (squares * period);
  }
  return out;
}

// Below this a velocity may be rest: in units of its rms value, and of the error that the encoder's
// step causes in it.
constexpr double kSmallPart = 0.03, kSmallErrors = 8.0;

double small_velocity(std::span<const double> rate, double step, double period) {
  double sum = 0.0, squares = 0.0;
  for (const double value : rate) sum += value * value;
  for (int i = 1; i <= kSlopeReach; ++i) squares += 2.0 * i * i;
  const double rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, rate.size())));
  return std::max(kSmallPart * rms, kSmallErrors * step / std::sqrt(12.0 * squares) / period);
}

}  // namespace

double encoder_step(std::span<const double> values) {
  double least = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = std::abs(values[k] - values[k - 1]);
    if (step > 0.0 && (least == 0.0 || step < least)) least = step;
  }
  return least;
}

std::vector<Interval> moving_intervals(std::span<const double> angle, double period) {
  const std::vector<double> rate = slopes(angle, period);
  const double small = small_velocity(rate, encoder_step(angle), period);
  std::vector<Interval> out;
  const int count = static_cast<int>(rate.size());
  const auto direction = [&](int k) {
    return rate[at(k)] > small ? 1 : rate[at(k)] < -small ? -1 : 0;
  };
  for (int k = 0; k < count;) {
    int end = k + 1;
    while (end < count && direction(end) == direction(k)) ++end;
    const Interval found{k + kSlopeReach, end - 1 - kSlopeReach, direction(k)};
    if (found.direction != 0 && found.length() > 1) out.push_back(found);
    k = end;
  }
  return out;
}

Modulation modulation(double x, bool odd) noexcept {
  if (!(x > 0.0 && x < 1.0)) return {};
  const double y = 4.0 * x * (1.0 - x), y1 = 4.0 - 8.0 * x, y2 = -8.0;
  const double y3 = y * y * y;
  const Modulation even{y3 * y, 4.0 * y3 * y1, 12.0 * y * y * y1 * y1 + 4.0 * y3 * y2};
  if (!odd) return even;
  const double z = 1.0 - 2.0 * x;
  return {z * even.value, z * even.first - 2.0 * even.value, z * even.second - 4.0 * even.first};
}

std::vector<Interval> windows_of(const Interval& interval, int longest) {
  const int length = std::min(interval.length(), longest);
  const int room = interval.length() - length;
  const int steps = room == 0 ? 0 : (2 * room + length - 1) / length;
  std::vector<Interval> out;
  for (int k = 0; k <= steps; ++k) {
    const int first = interval.first + (steps == 0 ? 0 : room * k / steps);
    out.push_back({first, first + length - 1, interval.direction});
  }
  return out;
}

}  // namespace footfall::lab
