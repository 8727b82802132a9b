// Equality of numbers by their bits: a NaN equals itself, and 0 differs from -0.
#pragma once

#include <bit>
#include <cstdint>

namespace footfall::core {

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace footfall::core
