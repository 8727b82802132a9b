// The table of statistics; see statistics.h.
#include "behaviors/expression/statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace footfall::behaviors {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void keep_greatest(StatisticState& s, double x) { s.value = std::max(s.value, x); }
void keep_smallest(StatisticState& s, double x) { s.value = std::min(s.value, x); }
void add_value(StatisticState& s, double x) { s.value += x; }
void add_square(StatisticState& s, double x) { s.value += x * x; }
void count_rise(StatisticState& s, double x) {
  const bool is_true = x != 0.0;
  if (is_true && !s.was_true) s.value += 1.0;
  s.was_true = is_true;
}

double as_it_is(const StatisticState& s) { return s.value; }
double mean_of(const StatisticState& s) { return s.value / static_cast<double>(s.samples); }
double root_mean_of(const StatisticState& s) { return std::sqrt(mean_of(s)); }

void move_top(std::vector<double>& from, bool from_low, std::vector<double>& to) {
  const auto push = [](std::vector<double>& heap, bool low) {
    low ? std::push_heap(heap.begin(), heap.end())
        : std::push_heap(heap.begin(), heap.end(), std::greater<>());
  };
  from_low ? std::pop_heap(from.begin(), from.end())
           : std::pop_heap(from.begin(), from.end(), std::greater<>());
  to.push_back(from.back());
  from.pop_back();
  push(to, !from_low);
}

// Nearest rank, exact: `low` holds the ceil(percent n / 100) smallest of n samples, its maximum is
// the result. O(log n) per sample.
template <int percent>
void keep_ordered(StatisticState& s, double x) {
  const auto n = static_cast<std::size_t>(s.samples);
  if (n > kMostKeptSamples) {
    s.low = s.high = {};
    return;
  }
  const std::size_t rank = (percent * n + 99) / 100;
  s.low.push_back(x);
  std::push_heap(s.low.begin(), s.low.end());
  move_top(s.low, true, s.high);
  if (s.low.size() < rank) move_top(s.high, false, s.low);
}
double greatest_low(const StatisticState& s) { return s.low.empty() ? kNan : s.low.front(); }

constexpr Statistic kStatisticRows[] = {
    {.name = "max",
     .doc = "the greatest value",
     .weight = 1.0,
     .start = -kInfinity,
     .update = keep_greatest,
     .result = as_it_is},
    {.name = "min",
     .doc = "the smallest value",
     .weight = -1.0,
     .start = kInfinity,
     .update = keep_smallest,
     .result = as_it_is},
    {.name = "mean", .doc = "the mean", .update = add_value, .result = mean_of},
    {.name = "rms",
     .doc = "the root of the mean square",
     .update = add_square,
     .result = root_mean_of},
    {.name = "p95",
     .doc = "95 % of the values are not greater than this one of them (nearest rank; of at most a "
            "million values)",
     .weight = 1.0,
     .keeps_samples = true,
     .update = keep_ordered<95>,
     .result = greatest_low},
    {.name = "count",
     .doc = "how often the signal became true (not 0)",
     .counts = true,
     .update = count_rise,
     .result = as_it_is},
};

}  // namespace

constinit const std::span<const Statistic> kStatistics = kStatisticRows;

const Statistic* find_statistic(std::string_view name) noexcept {
  const auto found = std::ranges::find(kStatistics, name, &Statistic::name);
  return found == kStatistics.end() ? nullptr : &*found;
}

bool RunningStatistic::add(double x) {
  const bool has_value = !std::isnan(x);
  if (has_value) ++state_.samples;
  if (has_value || of_->counts) of_->update(state_, has_value ? x : 0.0);
  if (!has_value) return false;
  const double weight = of_->weight == 0.0 ? std::abs(x) : of_->weight * x;
  if (weight <= heaviest_) return false;
  heaviest_ = weight;
  return true;
}

double RunningStatistic::value() const {
  return state_.samples > 0 || of_->counts ? of_->result(state_) : kNan;
}

}  // namespace footfall::behaviors
