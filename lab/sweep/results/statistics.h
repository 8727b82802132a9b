// The statistics of a sweep's report.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace footfall::lab {

// The part of successes with its Wilson score interval at 95 %. Source: E. B. Wilson, J. Am. Stat.
// Assoc. 22 (1927) 209. Nothing tried: 0 with the interval [0, 1].
struct Share {
  std::size_t good = 0, of = 0;
  double value() const;
  std::array<double, 2> interval() const;
};

// The value below which the part p (0..1) lies, linear between neighbours; NaN of nothing.
double quantile_of(std::vector<double> values, double p);
// Spearman's: of the ranks, equal values share theirs. NaN for fewer than 3 or where one is
// constant.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace footfall::lab
