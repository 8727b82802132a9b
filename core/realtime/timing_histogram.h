// Histogram of durations with fixed logarithmic bins: no allocation, percentiles accurate to 1.1 %.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace footfall::core {

class TimingHistogram {
 public:
  void add(std::int64_t ns) noexcept {
    if (ns < 1) ns = 1;
    const int bin = static_cast<int>(std::log2(static_cast<double>(ns)) * kPerOctave);
    ++bins_[static_cast<std::size_t>(bin < kBins ? bin : kBins - 1)];
    ++count_;
    if (ns > max_) max_ = ns;
  }
  std::int64_t count() const noexcept { return count_; }
  std::int64_t max_ns() const noexcept { return max_; }
  // Percentile in ns: a fraction `p` (0..1) of the samples is not above it; 0 without samples.
  double percentile(double p) const noexcept {
    const double wanted = p * static_cast<double>(count_);
    double seen = 0.0;
    for (int i = 0; i < kBins; ++i) {
      seen += static_cast<double>(bins_[static_cast<std::size_t>(i)]);
      if (seen >= wanted && seen > 0.0) return std::exp2((i + 0.5) / kPerOctave);
    }
    return 0.0;
  }

 private:
  static constexpr int kPerOctave = 32;
  static constexpr int kBins = 40 * kPerOctave;  // up to 2^40 ns = 18 min
  std::array<std::int64_t, kBins> bins_{};
  std::int64_t count_ = 0;
  std::int64_t max_ = 0;
};

}  // namespace footfall::core
