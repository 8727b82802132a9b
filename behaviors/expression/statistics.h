// Statistics of one signal over a time, such as `rms(task.height.error)`: the expectations of a
// scenario name them. One table for the parser, the judge and the reference.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace footfall::behaviors {

// Samples that a statistic of order keeps at most; beyond, it has no value.
inline constexpr std::size_t kMostKeptSamples = 1'000'000;

// The state of a computation; each statistic uses a part of it.
struct StatisticState {
  std::int64_t samples = 0;
  double value = 0.0;  // a sum, or an extreme so far
  bool was_true = false;
  std::vector<double> low, high;  // heaps: the kept samples up to the result, and those above it
};

struct Statistic {
  std::string_view name;
  std::string_view doc;
  // The sample at which the result is decided, for people: the one with the greatest x * weight,
  // or the greatest |x| where weight is 0.
  double weight = 0.0;
  double start = 0.0;          // StatisticState::value before the first sample
  bool counts = false;         // a plain number whatever the signal's unit, 0 without samples; a
                               // signal without a value (NaN) is a sample of 0
  bool keeps_samples = false;  // at most kMostKeptSamples
  void (*update)(StatisticState& state, double x) = nullptr;  // state.samples includes x already
  double (*result)(const StatisticState& state) = nullptr;
};

extern const std::span<const Statistic> kStatistics;

// nullptr if absent.
const Statistic* find_statistic(std::string_view name) noexcept;

// One statistic over the samples so far. May allocate.
class RunningStatistic {
 public:
  explicit RunningStatistic(const Statistic& of) : of_(&of) { state_.value = of.start; }

  // x: a value of the signal, NaN where it has none. True if x now decides the result.
  bool add(double x);
  // Without samples NaN; 0 where the statistic counts.
  double value() const;

 private:
  const Statistic* of_;
  StatisticState state_;
  double heaviest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace footfall::behaviors
