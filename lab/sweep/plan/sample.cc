// Samples by inverse distribution functions; see sample.h.
#include "lab/sweep/plan/sample.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace footfall::lab {
namespace {

// Not std::uniform_real_distribution: its results differ between standard libraries, those of the
// generator do not.
double unit(std::mt19937_64& generator) {
  return (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53;
}

std::uint64_t stream_of(const std::string& name, std::uint64_t seed) {
  std::uint64_t hash = 14695981039346656037ULL ^ (seed * 0x9E3779B97F4A7C15ULL);
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

double normal_part_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

// By bisection; the probability beyond 9 standard deviations is 1e-19.
double normal_quantile(double u) {
  double low = -9.0, high = 9.0;
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (normal_part_below(middle) < u ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<double> unit_draws(const std::string& name, std::uint64_t seed, std::size_t count,
                               SampleMethod method) {
  std::mt19937_64 generator(stream_of(name, seed));
  std::vector<double> draws(count);
  for (double& draw : draws) draw = unit(generator);
  if (method == SampleMethod::random) return draws;
  std::vector<std::size_t> part(count);
  std::iota(part.begin(), part.end(), std::size_t{0});
  for (std::size_t k = count; k > 1; --k) {  // Fisher and Yates
    const auto other = static_cast<std::size_t>(unit(generator) * static_cast<double>(k));
    std::swap(part[k - 1], part[other]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    draws[k] = (static_cast<double>(part[k]) + draws[k]) / static_cast<double>(count);
  }
  return draws;
}

double quantile(const DistributionSpec& d, double u) {
  switch (d.kind) {
    case Distribution::uniform:
      return d.a + u * (d.b - d.a);
    case Distribution::log_uniform:
      return d.a * std::pow(d.b / d.a, u);
    case Distribution::normal: {
      const double below = normal_part_below((d.low - d.a) / d.b);
      const double above = normal_part_below((d.high - d.a) / d.b);
      const double value = d.a + d.b * normal_quantile(below + u * (above - below));
      return std::clamp(value, d.low, d.high);
    }
  }
  return d.a;
}

}  // namespace footfall::lab
