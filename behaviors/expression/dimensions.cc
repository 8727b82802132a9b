// Dimensions of sums, products and powers, and what is refused; see parser.h.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "behaviors/expression/parser.h"

namespace footfall::behaviors {

Operand ExpressionParser::unify(const Operand& a, const Operand& b, const Token& at,
                                const std::string& what) {
  if (a.dimension == b.dimension) return {a.dimension, a.bare && b.bare, false, 0.0};
  if (a.bare) return {b.dimension, false, false, 0.0};
  if (b.bare) return {a.dimension, false, false, 0.0};
  fail(at, "dimension",
       fmt::format("cannot {} {} and {}", what, core::dimension_name(a.dimension),
                   core::dimension_name(b.dimension)));
}

core::Dimension ExpressionParser::combine(core::Dimension a, core::Dimension b, bool times,
                                          const Token& at) {
  constexpr int kLargestExponent = 12;
  const int sign = times ? 1 : -1;
  const int m = a.m + sign * b.m, kg = a.kg + sign * b.kg, s = a.s + sign * b.s;
  if (std::max({std::abs(m), std::abs(kg), std::abs(s)}) > kLargestExponent) {
    fail(at, "dimension",
         fmt::format("no quantity has a unit to the power of more than {}", kLargestExponent));
  }
  return times ? a * b : a / b;
}

void ExpressionParser::require_plain(const Operand& a, const Token& at, const std::string& what) {
  if (!(a.dimension == core::kNone)) {
    fail(at, "dimension",
         fmt::format("{} expects a plain number, got {}", what, core::dimension_name(a.dimension)));
  }
}

Operand ExpressionParser::raise(const Operand& base, const Operand& exponent, const Token& at) {
  if (base.dimension == core::kNone) return {core::kNone, base.bare && exponent.bare, false, 0.0};
  const int n = static_cast<int>(std::clamp(exponent.value, -9.0, 9.0));
  if (!exponent.literal || static_cast<double>(n) != exponent.value) {
    fail(at, "dimension", "the exponent of a quantity with a unit must be a small whole number");
  }
  core::Dimension dimension;
  for (int k = 0; k < std::abs(n); ++k) {
    dimension = combine(dimension, base.dimension, n > 0, at);
  }
  return {dimension, false, false, 0.0};
}

}  // namespace footfall::behaviors
