// Statistics of a sweep's report; see statistics.h.
#include "lab/sweep/results/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace footfall::lab {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kNormal95 = 1.959963984540054;  // 0.975 quantile of the normal distribution

// Ranks from 1; equal values share their mean rank.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double shared = 0.5 * static_cast<double>(begin + end + 1);
    for (; begin < end; ++begin) rank[order[begin]] = shared;
  }
  return rank;
}

}  // namespace

double Share::value() const {
  return of == 0 ? 0.0 : static_cast<double>(good) / static_cast<double>(of);
}

std::array<double, 2> Share::interval() const {
  if (of == 0) return {0.0, 1.0};
  const double n = static_cast<double>(of), p = value(), z2 = kNormal95 * kNormal95;
  const double centre = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half =
      kNormal95 / (1.0 + z2 / n) * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

double quantile_of(std::vector<double> values, double p) {
  if (values.empty()) return kNaN;
  std::ranges::sort(values);
  const double at = p * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size() || x.size() < 3) return kNaN;
  const std::vector<double> a = ranks(x), b = ranks(y);
  const double mean = 0.5 * static_cast<double>(a.size() + 1);
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    aa += (a[k] - mean) * (a[k] - mean);
    bb += (b[k] - mean) * (b[k] - mean);
    ab += (a[k] - mean) * (b[k] - mean);
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : kNaN;
}

}  // namespace footfall::lab
