// Robots, charts and tables are indexed by int (-1: none), the standard containers by size_t.
#pragma once

#include <cstddef>

namespace footfall {

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

// The same for the length of a container.
constexpr std::size_t extent(int n) noexcept { return static_cast<std::size_t>(n); }

}  // namespace footfall
