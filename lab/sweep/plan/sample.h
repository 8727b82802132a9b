// Random samples for a sweep, identical on every machine and in every session.
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
  double a = 0.0, b = 1.0;  // interval; for `normal` mean and standard deviation
  double low = -std::numeric_limits<double>::infinity();  // bounds of a truncated `normal`
  double high = std::numeric_limits<double>::infinity();
};

// `count` samples in (0, 1) for the parameter `name`. Each parameter has its own stream, so that
// further parameters and (with `random`) a larger count do not change the others.
std::vector<double> unit_draws(const std::string& name, std::uint64_t seed, std::size_t count,
                               SampleMethod method);
// Quantile: the value below which a fraction u (0..1) of the distribution lies.
double quantile(const DistributionSpec& distribution, double u);

}  // namespace footfall::lab
