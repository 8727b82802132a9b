// Statistics of one signal over a time window, such as `rms(task.height.error)`, for the
// expectations of scenarios. One table for the parser, the judge and the reference.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace footfall::behaviors {

// Maximum number of samples kept by an order statistic; with more it has no value.
inline constexpr std::size_t kMostKeptSamples = 1'000'000;

// The state of a computation; each statistic uses part of it.
struct StatisticState {
  std::int64_t samples = 0;
  double value = 0.0;  // sum, or extreme value so far
  bool was_true = false;
  std::vector<double> low, high;  // heaps: the kept samples up to the result, and those above it
};

struct Statistic {
  std::string_view name;
  std::string_view doc;
  // The sample that decides the result, for messages: the one with the largest x * weight, or the
  // largest |x| if weight is 0.
  double weight = 0.0;
  double start = 0.0;          // StatisticState::value before the first sample
  bool counts = false;         // a plain number whatever the signal's unit, 0 without samples; a
                               // signal without a value (NaN) is a sample of 0
  bool keeps_samples = false;  // limited to kMostKeptSamples
  void (*update)(StatisticState& state, double x) = nullptr;  // state.samples includes x already
  double (*result)(const StatisticState& state) = nullptr;
};

extern const std::span<const Statistic> kStatistics;

// nullptr if absent.
const Statistic* find_statistic(std::string_view name) noexcept;

// A statistic over the samples so far. May allocate.
class RunningStatistic {
 public:
  explicit RunningStatistic(const Statistic& of) : of_(&of) { state_.value = of.start; }

  // x: value of the signal, NaN if missing. Returns true if x now decides the result.
  bool add(double x);
  // NaN without samples; 0 if the statistic counts.
  double value() const;

 private:
  const Statistic* of_;
  StatisticState state_;
  double heaviest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace footfall::behaviors
