// Values drawn at random for a sweep, the same on every machine and in every session.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace footfall::lab {

enum class Distribution : std::uint8_t { uniform, log_uniform, normal };
enum class SampleMethod : std::uint8_t { random, latin_hypercube };

struct DistributionSpec {
  Distribution kind = Distribution::uniform;
  double a = 0.0, b = 1.0;  // ends; of `normal` mean and standard deviation
  double low = -std::numeric_limits<double>::infinity();  // `normal` is cut off here
  double high = std::numeric_limits<double>::infinity();
};

// `count` draws in (0, 1) for the parameter `name`: a stream of its own, so that other parameters
// and (with `random`) a larger count change nothing.
std::vector<double> unit_draws(const std::string& name, std::uint64_t seed, std::size_t count,
                               SampleMethod method);
// The value below which the part u (0..1) of the distribution lies.
double quantile(const DistributionSpec& distribution, double u);

}  // namespace footfall::lab
