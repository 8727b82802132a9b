// Arithmetic of expressions, in the tick; see kernels.h.
#include "behaviors/expression/kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace footfall::behaviors {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

template <Source source>
double fetch(StepOperand operand, double accumulator, const EvaluationContext& c,
             const double* stored) noexcept {
  if constexpr (source == Source::accumulator) return accumulator;
  if constexpr (source == Source::stored) return stored[operand.index];
  if constexpr (source == Source::constant) return operand.value;
  if constexpr (source == Source::parameter) return c.parameters[operand.index];
  if constexpr (source == Source::signal) return c.signals[operand.index];
  if constexpr (source == Source::state_time) {
    return static_cast<double>(c.tick - c.entry_ticks[operand.index]) * c.period;
  }
  if constexpr (source == Source::time) return static_cast<double>(c.tick) * c.period;
  if constexpr (source == Source::in_state) return c.active[operand.index] != 0 ? 1.0 : 0.0;
  if constexpr (source == Source::entry) return c.entry == nullptr ? kNaN : c.entry[operand.index];
}

// A comparison with a non-finite operand is not finite, so that it finally counts as false. Testing
// the difference is sufficient unless it overflows.
template <Op op>
double compare(double a, double b) noexcept {
  if (!std::isfinite(a - b) && !(std::isfinite(a) && std::isfinite(b))) return kNaN;
  if constexpr (op == Op::less) return a < b ? 1.0 : 0.0;
  if constexpr (op == Op::less_equal) return a <= b ? 1.0 : 0.0;
  if constexpr (op == Op::equal) return a == b ? 1.0 : 0.0;
  if constexpr (op == Op::not_equal) return a != b ? 1.0 : 0.0;
}

// `and`, `or` evaluate the right side only if the left one does not decide.
template <Op op>
double logic(double a, double b) noexcept {
  if (!std::isfinite(a)) return kNaN;
  const bool left = a != 0.0;
  if (op == Op::logical_and && !left) return 0.0;
  if (op == Op::logical_or && left) return 1.0;
  if (!std::isfinite(b)) return kNaN;
  return b != 0.0 ? 1.0 : 0.0;
}

template <Op op>
double binary(double a, double b) noexcept {
  if constexpr (op == Op::add) {
    return a + b;
  } else if constexpr (op == Op::subtract) {
    return a - b;
  } else if constexpr (op == Op::multiply) {
    return a * b;
  } else if constexpr (op == Op::divide) {
    return b == 0.0 ? kNaN : a / b;
  } else if constexpr (op == Op::power) {
    return std::pow(a, b);
  } else if constexpr (op == Op::minimum) {
    return b < a ? b : a <= b ? a : kNaN;
  } else if constexpr (op == Op::maximum) {
    return a < b ? b : b <= a ? a : kNaN;
  } else if constexpr (op == Op::arctangent2) {
    return std::atan2(a, b);
  } else if constexpr (op == Op::hypotenuse) {
    return std::hypot(a, b);
  } else if constexpr (op == Op::logical_and || op == Op::logical_or) {
    return logic<op>(a, b);
  } else {
    return compare<op>(a, b);
  }
}

template <Unary op>
double unary(double a) noexcept {
  if constexpr (op == Unary::load) return a;
  if constexpr (op == Unary::truth) return std::isfinite(a) ? (a != 0.0 ? 1.0 : 0.0) : kNaN;
  if constexpr (op == Unary::negate) return -a;
  if constexpr (op == Unary::logical_not) return std::isfinite(a) ? (a == 0.0 ? 1.0 : 0.0) : kNaN;
  if constexpr (op == Unary::absolute) return std::abs(a);
  if constexpr (op == Unary::square_root) return std::sqrt(a);
  if constexpr (op == Unary::sine) return std::sin(a);
  if constexpr (op == Unary::cosine) return std::cos(a);
  if constexpr (op == Unary::exponential) return std::exp(a);
  if constexpr (op == Unary::logarithm) return std::log(a);
  if constexpr (op == Unary::square) return a * a;
  if constexpr (op == Unary::cube) return a * a * a;
}

template <Op op>
double ternary(double first, double a, double b) noexcept {
  if constexpr (op == Op::select) {
    return !std::isfinite(first) ? kNaN : first != 0.0 ? a : b;
  } else {
    return a <= b && !std::isnan(first) ? std::clamp(first, a, b) : kNaN;
  }
}

template <Scaled op>
double scaled(double other, double product) noexcept {
  if constexpr (op == Scaled::plus) return other + product;
  if constexpr (op == Scaled::minus) return other - product;
  if constexpr (op == Scaled::from) return product - other;
}

// Continues with another step.
double go_on(const Step* next, double accumulator, const EvaluationContext& c,
             double* stored) noexcept {
  return next->kernel(next, accumulator, c, stored);
}

template <Control control>
double control_step(const Step* s, double accumulator, const EvaluationContext& c,
                    double* stored) noexcept {
  if constexpr (control == Control::finish) {
    return accumulator;
  } else {
    std::int64_t jump = s->left.index;
    if constexpr (control == Control::unless_true) jump = accumulator == 1.0 ? 1 : jump;
    if constexpr (control == Control::unless_false) jump = accumulator == 0.0 ? 1 : jump;
    if constexpr (control == Control::choose) {
      jump = accumulator == 1.0 ? 1 : accumulator == 0.0 ? jump : s->right.index;
    }
    return go_on(s + jump, accumulator, c, stored);
  }
}

template <Unary op, Source source>
double unary_step(const Step* s, double accumulator, const EvaluationContext& c,
                  double* stored) noexcept {
  if constexpr (op == Unary::store) {
    stored[s->right.index] = accumulator;
    return go_on(s + 1, accumulator, c, stored);
  } else {
    return go_on(s + 1, unary<op>(fetch<source>(s->left, accumulator, c, stored)), c, stored);
  }
}

template <Op op, Source left, Source right>
double binary_step(const Step* s, double accumulator, const EvaluationContext& c,
                   double* stored) noexcept {
  const double a = fetch<left>(s->left, accumulator, c, stored);
  const double b = fetch<right>(s->right, accumulator, c, stored);
  return go_on(s + 1, binary<op>(a, b), c, stored);
}

template <Op op, Source left, Source right>
double ternary_step(const Step* s, double accumulator, const EvaluationContext& c,
                    double* stored) noexcept {
  const double a = fetch<left>(s->left, accumulator, c, stored);
  const double b = fetch<right>(s->right, accumulator, c, stored);
  return go_on(s + 1, ternary<op>(accumulator, a, b), c, stored);
}

template <Scaled op, Source left, Source right>
double scaled_step(const Step* s, double accumulator, const EvaluationContext& c,
                   double* stored) noexcept {
  const double product = fetch<right>(s->right, accumulator, c, stored) * accumulator;
  const double other = fetch<left>(s->left, accumulator, c, stored);
  return go_on(s + 1, scaled<op>(other, product), c, stored);
}

template <Op outer, Op inner, Source left, Source right>
double nested_step(const Step* s, double accumulator, const EvaluationContext& c,
                   double* stored) noexcept {
  const double a = fetch<left>(s->left, accumulator, c, stored);
  const double b = fetch<right>(s->right, accumulator, c, stored);
  return go_on(s + 1, binary<outer>(accumulator, binary<inner>(a, b)), c, stored);
}

// The comparison is evaluated only if the accumulator does not decide.
template <Op logic, Op comparison, Source left, Source right>
double guard_step(const Step* s, double accumulator, const EvaluationContext& c,
                  double* stored) noexcept {
  constexpr double kGoesOn = logic == Op::logical_and ? 1.0 : 0.0;
  const double a = fetch<left>(s->left, accumulator, c, stored);
  const double b = fetch<right>(s->right, accumulator, c, stored);
  return go_on(s + 1, accumulator == kGoesOn ? compare<comparison>(a, b) : accumulator, c, stored);
}

constexpr Source source_of(std::size_t k) { return static_cast<Source>(k); }

template <std::size_t... k>
constexpr auto unary_table(std::index_sequence<k...>) {
  return std::array<Kernel, sizeof...(k)>{
      unary_step<static_cast<Unary>(k / kSources), source_of(k % kSources)>...};
}
constexpr auto kUnary = unary_table(std::make_index_sequence<kUnaries * kSources>());

template <Op op, std::size_t... k>
constexpr auto binary_table(std::index_sequence<k...>) {
  return std::array<Kernel, sizeof...(k)>{
      binary_step<op, source_of(k / kPairSources), source_of(k % kPairSources)>...};
}
template <Op op, std::size_t... k>
constexpr auto ternary_table(std::index_sequence<k...>) {
  return std::array<Kernel, sizeof...(k)>{
      ternary_step<op, source_of(k / kPairSources), source_of(k % kPairSources)>...};
}
template <Scaled op, std::size_t... k>
constexpr auto scaled_table(std::index_sequence<k...>) {
  return std::array<Kernel, sizeof...(k)>{
      scaled_step<op, source_of(k / kPairSources), source_of(k % kPairSources)>...};
}
template <Op outer, Op inner, std::size_t... k>
constexpr auto nested_table(std::index_sequence<k...>) {
  return std::array<Kernel, sizeof...(k)>{
      nested_step<outer, inner, source_of(k / kPairSources), source_of(k % kPairSources)>...};
}
template <Op logic, Op comparison, std::size_t... k>
constexpr auto guard_table(std::index_sequence<k...>) {
  return std::array<Kernel, sizeof...(k)>{
      guard_step<logic, comparison, source_of(k / kPairSources), source_of(k % kPairSources)>...};
}
using Pairs = std::make_index_sequence<kPairSources * kPairSources>;
template <Op op>
constexpr auto kBinary = binary_table<op>(Pairs());
template <Op op>
constexpr auto kTernary = ternary_table<op>(Pairs());
template <Scaled op>
constexpr auto kScaled = scaled_table<op>(Pairs());
template <Op outer, Op inner>
constexpr auto kNested = nested_table<outer, inner>(Pairs());
template <Op logic, Op comparison>
constexpr auto kGuard = guard_table<logic, comparison>(Pairs());

std::size_t pair(Source left, Source right) {
  return static_cast<std::size_t>(left) * kPairSources + static_cast<std::size_t>(right);
}

// Selects the kernel of the matching operation.
template <Op... ops>
Kernel find_binary(Op op, std::size_t operands) {
  Kernel kernel = nullptr;
  static_cast<void>(((op == ops && (kernel = kBinary<ops>[operands])) || ...));
  return kernel;
}

template <Op logic, Op... comparisons>
Kernel find_guard(Op comparison, std::size_t operands) {
  Kernel kernel = nullptr;
  static_cast<void>(
      ((comparison == comparisons && (kernel = kGuard<logic, comparisons>[operands])) || ...));
  return kernel;
}

template <Op... outers>
Kernel find_nested(Op outer, Op inner, std::size_t operands) {
  Kernel kernel = nullptr;
  const auto find = [&](auto of) {
    constexpr Op o = decltype(of)::value;
    kernel = inner == Op::add        ? kNested<o, Op::add>[operands]
             : inner == Op::subtract ? kNested<o, Op::subtract>[operands]
             : inner == Op::multiply ? kNested<o, Op::multiply>[operands]
                                     : nullptr;
    return true;
  };
  static_cast<void>(((outer == outers && find(std::integral_constant<Op, outers>())) || ...));
  return kernel;
}

}  // namespace

Kernel control_kernel(Control control) {
  switch (control) {
    case Control::finish:
      return control_step<Control::finish>;
    case Control::unless_true:
      return control_step<Control::unless_true>;
    case Control::unless_false:
      return control_step<Control::unless_false>;
    case Control::choose:
      return control_step<Control::choose>;
    default:
      return control_step<Control::jump>;
  }
}

Kernel unary_kernel(Unary op, Source source) {
  return kUnary[static_cast<std::size_t>(op) * kSources + static_cast<std::size_t>(source)];
}

Kernel binary_kernel(Op op, Source left, Source right) {
  return find_binary<Op::add, Op::subtract, Op::multiply, Op::divide, Op::power, Op::less,
                     Op::less_equal, Op::equal, Op::not_equal, Op::logical_and, Op::logical_or,
                     Op::minimum, Op::maximum, Op::arctangent2, Op::hypotenuse>(op,
                                                                                pair(left, right));
}

Kernel ternary_kernel(Op op, Source left, Source right) {
  return (op == Op::select ? kTernary<Op::select> : kTernary<Op::clamp>)[pair(left, right)];
}

Kernel scaled_kernel(Scaled op, Source left, Source right) {
  const std::size_t operands = pair(left, right);
  return op == Scaled::plus    ? kScaled<Scaled::plus>[operands]
         : op == Scaled::minus ? kScaled<Scaled::minus>[operands]
                               : kScaled<Scaled::from>[operands];
}

Kernel nested_kernel(Op outer, Op inner, Source left, Source right) {
  return find_nested<Op::add, Op::subtract, Op::multiply, Op::divide>(outer, inner,
                                                                      pair(left, right));
}

Kernel guard_kernel(Op logic, Op comparison, Source left, Source right) {
  const std::size_t operands = pair(left, right);
  return logic == Op::logical_and
             ? find_guard<Op::logical_and, Op::less, Op::less_equal, Op::equal, Op::not_equal>(
                   comparison, operands)
             : find_guard<Op::logical_or, Op::less, Op::less_equal, Op::equal, Op::not_equal>(
                   comparison, operands);
}

}  // namespace footfall::behaviors
