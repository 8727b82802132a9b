// Evaluation of compiled expressions, in the tick; see expression.h.
#include "behaviors/expression.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace footfall::behaviors {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A comparison of something that is not finite is not finite itself, so that it counts as false
// wherever it ends up.
double compare(Op op, double a, double b) noexcept {
  if (!std::isfinite(a) || !std::isfinite(b)) return kNaN;
  switch (op) {
    case Op::less:
      return a < b ? 1.0 : 0.0;
    case Op::less_equal:
      return a <= b ? 1.0 : 0.0;
    case Op::greater:
      return a > b ? 1.0 : 0.0;
    case Op::greater_equal:
      return a >= b ? 1.0 : 0.0;
    case Op::equal:
      return a == b ? 1.0 : 0.0;
    default:
      return a != b ? 1.0 : 0.0;
  }
}

// `and`, `or` look at the right side only if the left does not decide.
double logic(Op op, double a, double b) noexcept {
  if (!std::isfinite(a)) return kNaN;
  const bool left = a != 0.0;
  if (op == Op::logical_and && !left) return 0.0;
  if (op == Op::logical_or && left) return 1.0;
  if (!std::isfinite(b)) return kNaN;
  return b != 0.0 ? 1.0 : 0.0;
}

double binary(Op op, double a, double b) noexcept {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return b == 0.0 ? kNaN : a / b;
    case Op::power:
      return std::pow(a, b);
    case Op::minimum:
      return std::isnan(a) || std::isnan(b) ? kNaN : std::min(a, b);
    case Op::maximum:
      return std::isnan(a) || std::isnan(b) ? kNaN : std::max(a, b);
    case Op::arctangent2:
      return std::atan2(a, b);
    case Op::hypotenuse:
      return std::hypot(a, b);
    case Op::logical_and:
    case Op::logical_or:
      return logic(op, a, b);
    default:
      return compare(op, a, b);
  }
}

double unary(Op op, double a) noexcept {
  switch (op) {
    case Op::negate:
      return -a;
    case Op::logical_not:
      return std::isfinite(a) ? (a == 0.0 ? 1.0 : 0.0) : kNaN;
    case Op::absolute:
      return std::abs(a);
    case Op::square_root:
      return std::sqrt(a);
    case Op::sine:
      return std::sin(a);
    case Op::cosine:
      return std::cos(a);
    case Op::exponential:
      return std::exp(a);
    default:
      return std::log(a);
  }
}

double load(const Instruction& i, const EvaluationContext& c) noexcept {
  switch (i.op) {
    case Op::constant:
      return i.value;
    case Op::parameter:
      return c.parameters[i.index];
    case Op::signal:
      return c.signals[i.index];
    case Op::state_time:
      return static_cast<double>(c.tick - c.entry_ticks[i.index]) * c.period;
    case Op::time:
      return static_cast<double>(c.tick) * c.period;
    case Op::in_state:
      return c.active[i.index] != 0 ? 1.0 : 0.0;
    default:
      return c.entry == nullptr ? kNaN : c.entry[i.index];
  }
}

int append(ExpressionPool& pool, Instruction instruction, core::Dimension dimension,
           bool constant) {
  pool.expressions.push_back({static_cast<int>(pool.code.size()), 1, dimension, false, constant});
  pool.code.push_back(instruction);
  return pool.size() - 1;
}

}  // namespace

double evaluate(const ExpressionPool& pool, int expression,
                const EvaluationContext& context) noexcept {
  double stack[kExpressionStack];
  int top = 0;  // values on the stack; the compiler bounds it
  const Expression& e = pool[expression];
  const Instruction* code = pool.code.data() + e.first;
  for (int k = 0; k < e.count; ++k) {
    const Instruction& i = code[k];
    if (i.op <= Op::entry) {
      stack[top++] = load(i, context);
    } else if (i.op == Op::select) {
      top -= 2;
      const double c = stack[top - 1];
      stack[top - 1] = !std::isfinite(c) ? kNaN : c != 0.0 ? stack[top] : stack[top + 1];
    } else if (i.op == Op::clamp) {
      top -= 2;
      const double x = stack[top - 1], low = stack[top], high = stack[top + 1];
      stack[top - 1] = low <= high && !std::isnan(x) ? std::clamp(x, low, high) : kNaN;
    } else if (i.op == Op::negate || i.op == Op::logical_not || i.op == Op::absolute ||
               i.op == Op::square_root || i.op == Op::sine || i.op == Op::cosine ||
               i.op == Op::exponential || i.op == Op::logarithm) {
      stack[top - 1] = unary(i.op, stack[top - 1]);
    } else {
      --top;
      stack[top - 1] = binary(i.op, stack[top - 1], stack[top]);
    }
  }
  return stack[0];
}

int ExpressionPool::add_constant(double value, core::Dimension dimension) {
  return append(*this, {Op::constant, 0, value}, dimension, true);
}

int ExpressionPool::add_signal(int signal, core::Dimension dimension) {
  return append(*this, {Op::signal, signal, 0.0}, dimension, false);
}

int ExpressionPool::add_parameter(int slot, core::Dimension dimension) {
  return append(*this, {Op::parameter, slot, 0.0}, dimension, false);
}

}  // namespace footfall::behaviors
