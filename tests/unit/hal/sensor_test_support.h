// Statistics with derived bounds: five standard deviations of the estimate itself.
#pragma once

#include <cmath>
#include <vector>

namespace footfall::hal {

constexpr double kTick = 1.0 / 1500.0;  // s
constexpr double kSigmas = 5.0;
constexpr double kDigit = 0x1p-20;  // of digital sensors

inline double mean_of(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

// About a mean that is known to be 0.
inline double variance_of(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v * v;
  return sum / static_cast<double>(x.size());
}

// Of independent normal numbers: the estimate's deviation is sqrt(2 / n) of it.
inline double variance_bound(double variance, std::size_t n) {
  return kSigmas * variance * std::sqrt(2.0 / static_cast<double>(n));
}

inline double mean_bound(double deviation, std::size_t n) {
  return kSigmas * deviation / std::sqrt(static_cast<double>(n));
}

// Half the mean square of the difference of adjacent means over `m` samples.
inline double allan_variance(const std::vector<double>& x, std::size_t m) {
  double sum = 0.0, before = 0.0;
  const std::size_t clusters = x.size() / m;
  for (std::size_t c = 0; c < clusters; ++c) {
    double now = 0.0;
    for (std::size_t k = 0; k < m; ++k) now += x[c * m + k] / static_cast<double>(m);
    if (c > 0) sum += 0.5 * (now - before) * (now - before);
    before = now;
  }
  return sum / static_cast<double>(clusters - 1);
}

}  // namespace footfall::hal
