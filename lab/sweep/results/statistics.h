// Statistics of a sweep's report.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace footfall::lab {

// The fraction of successes with its Wilson score interval at 95 %. Source: E. B. Wilson, J. Am.
// Stat. Assoc. 22 (1927) 209. Without trials: 0 with the interval [0, 1].
struct Share {
  std::size_t good = 0, of = 0;
  double value() const;
  std::array<double, 2> interval() const;
};

// p-quantile (0..1), linear between neighbours; NaN if empty.
double quantile_of(std::vector<double> values, double p);
// Spearman's rank correlation; equal values share their mean rank. NaN for fewer than 3 values or
// if one of the variables is constant.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace footfall::lab
