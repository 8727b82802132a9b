// Physical dimensions and quantities with units: `16 ms`, `220 1/s^2`, `8 Nm`, `70 %`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace footfall::core {

// A space or tab.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Exponents of metre, kilogram and second; an angle is dimensionless (rad = 1).
struct Dimension {
  std::int8_t m = 0;
  std::int8_t kg = 0;
  std::int8_t s = 0;
  friend constexpr bool operator==(Dimension, Dimension) = default;
};

constexpr Dimension operator*(Dimension a, Dimension b) {
  return {static_cast<std::int8_t>(a.m + b.m), static_cast<std::int8_t>(a.kg + b.kg),
          static_cast<std::int8_t>(a.s + b.s)};
}
constexpr Dimension operator/(Dimension a, Dimension b) {
  return {static_cast<std::int8_t>(a.m - b.m), static_cast<std::int8_t>(a.kg - b.kg),
          static_cast<std::int8_t>(a.s - b.s)};
}

inline constexpr Dimension kNone{0, 0, 0};
inline constexpr Dimension kLength{1, 0, 0};
inline constexpr Dimension kTime{0, 0, 1};
inline constexpr Dimension kMass{0, 1, 0};
inline constexpr Dimension kForce{1, 1, -2};
inline constexpr Dimension kTorque{2, 1, -2};
inline constexpr Dimension kVelocity{1, 0, -1};
inline constexpr Dimension kAcceleration{1, 0, -2};
inline constexpr Dimension kRate{0, 0, -1};         // angular velocity, frequency, kd
inline constexpr Dimension kRateSquared{0, 0, -2};  // angular acceleration, kp
inline constexpr Dimension kInertia{2, 1, 0};
inline constexpr Dimension kImpulse{1, 1, -1};
inline constexpr Dimension kAngularMomentum{2, 1, -1};

// A number in SI units with its dimension; `bare` if written without a unit.
struct Quantity {
  double value = 0.0;
  Dimension dimension;
  bool bare = true;
};

// Parses `NUMBER [UNIT]` (decimal, exponent; units with * / ^ and common prefixes). Empty for
// anything else, for a non-finite number, and for an unknown unit.
std::optional<Quantity> parse_quantity(std::string_view text);
// Parses a unit expression such as `kg m^2`, `1/s^2`, `Nm`, `%`: its SI factor and dimension.
std::optional<Quantity> parse_unit(std::string_view text);
// "a time", "a length", "a plain number"; the SI unit for dimensions without a common name.
std::string dimension_name(Dimension dimension);
// SI unit text for logs and plots: "m/s^2", "N", "Nm", "" for a plain number.
std::string unit_text(Dimension dimension);

}  // namespace footfall::core
