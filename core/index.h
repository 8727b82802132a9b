// Index conversions: robots, charts and tables use int (-1: none), standard containers size_t.
#pragma once

#include <cstddef>
#include <cstdint>

namespace footfall {

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
constexpr std::size_t at(std::int64_t i) noexcept { return static_cast<std::size_t>(i); }  // ticks

// Same for the length of a container.
constexpr std::size_t extent(int n) noexcept { return static_cast<std::size_t>(n); }

}  // namespace footfall
