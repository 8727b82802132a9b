// Converts postfix code back to text; see guard_terms.h.
#include "behaviors/explain/guard_terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace footfall::behaviors {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct OpInfo {
  int operands = 0;
  const char* name = "";
  bool infix = false;
};

OpInfo op_info(Op op) {
  switch (op) {
    case Op::constant:
    case Op::parameter:
    case Op::signal:
    case Op::state_time:
    case Op::time:
    case Op::in_state:
    case Op::entry:
      return {};
    case Op::negate:
      return {1, "-"};
    case Op::logical_not:
      return {1, "not "};
    case Op::add:
      return {2, "+", true};
    case Op::subtract:
      return {2, "-", true};
    case Op::multiply:
      return {2, "*", true};
    case Op::divide:
      return {2, "/", true};
    case Op::power:
      return {2, "^", true};
    case Op::less:
      return {2, "<", true};
    case Op::less_equal:
      return {2, "<=", true};
    case Op::greater:
      return {2, ">", true};
    case Op::greater_equal:
      return {2, ">=", true};
    case Op::equal:
      return {2, "==", true};
    case Op::not_equal:
      return {2, "!=", true};
    case Op::logical_and:
      return {2, "and", true};
    case Op::logical_or:
      return {2, "or", true};
    case Op::select:
      return {3, "select"};
    case Op::absolute:
      return {1, "abs"};
    case Op::minimum:
      return {2, "min"};
    case Op::maximum:
      return {2, "max"};
    case Op::clamp:
      return {3, "clamp"};
    case Op::square_root:
      return {1, "sqrt"};
    case Op::sine:
      return {1, "sin"};
    case Op::cosine:
      return {1, "cos"};
    case Op::arctangent2:
      return {2, "atan2"};
    case Op::hypotenuse:
      return {2, "hypot"};
    case Op::exponential:
      return {1, "exp"};
    case Op::logarithm:
      return {1, "log"};
  }
  return {};
}

bool compares(Op op) { return op >= Op::less && op <= Op::not_equal; }

// Splits postfix code into terms; a subexpression is the range of code that ends with its
// operation.
class Terms {
 public:
  Terms(const Behavior& behavior, const EvaluationContext& context)
      : behavior_(behavior), context_(context) {}

  std::vector<GuardTerm> terms;

  // Splits the subexpression that ends at `last` into terms; returns its beginning.
  int split(int last) {
    const Op op = code(last).op;
    if (op == Op::logical_and || op == Op::logical_or) {
      const int right = begin_of(last - 1);
      const int left = split(right - 1);
      split(last - 1);
      return left;
    }
    if (op == Op::logical_not && is_logic(last - 1)) return split(last - 1);
    const int first = begin_of(last);
    const double value = evaluate_part(first, last);
    GuardTerm term{"", std::isfinite(value) && value != 0.0};
    if (compares(op)) {
      const int right = begin_of(last - 1);
      term.text = fmt::format("{} {} {}", side(first, right - 1, right, last - 1), op_info(op).name,
                              side(right, last - 1, first, right - 1));
    } else {
      term.text = fmt::format("{} {}", words(last), term.holds ? "true" : "false");
    }
    terms.push_back(std::move(term));
    return first;
  }

 private:
  const Instruction& code(int i) const { return behavior_.expressions.code[at(i)]; }

  bool is_logic(int last) const {
    const Op op = code(last).op;
    return op == Op::logical_and || op == Op::logical_or || op == Op::logical_not;
  }

  int begin_of(int last) const {
    int first = last;
    for (int k = op_info(code(last).op).operands; k > 0; --k) first = begin_of(first - 1);
    return first;
  }

  // Uses the engine's own evaluation.
  double evaluate_part(int first, int last) const {
    ExpressionPool pool;
    const auto begin = behavior_.expressions.code.begin();
    const int index = pool.add({begin + first, begin + last + 1}, {}, false, false);
    return evaluate(pool, index, context_);
  }

  // One side of a comparison: its text (unless it is a number), then its value.
  std::string side(int first, int last, int other_first, int other_last) const {
    const std::string unit = unit_of(first == last               ? last
                                     : other_first == other_last ? other_last
                                                                 : last);
    const std::string other = unit_of(other_last);
    const std::string value =
        fmt::format("{:.6g}{}", evaluate_part(first, last),
                    unit.empty() ? (other.empty() ? "" : " " + other) : " " + unit);
    return code(last).op == Op::constant ? value : words(last) + " " + value;
  }

  std::string unit_of(int last) const {
    const Instruction& in = code(last);
    switch (in.op) {
      case Op::signal:
        return core::unit_text(behavior_.signals.info(in.index).dimension);
      case Op::parameter:
        for (const ParameterInfo& p : behavior_.parameters) {
          if (in.index >= p.slot && in.index < p.slot + p.size) return core::unit_text(p.dimension);
        }
        return "";
      case Op::state_time:
      case Op::time:
        return "s";
      default:
        return "";
    }
  }

  std::string words(int last) const {
    const Instruction& in = code(last);
    switch (in.op) {
      case Op::constant:
        return fmt::format("{:.6g}", in.value);
      case Op::parameter:
        for (const ParameterInfo& p : behavior_.parameters) {
          if (in.index < p.slot || in.index >= p.slot + p.size) continue;
          return p.size == 1 ? "$" + p.name : fmt::format("${}[{}]", p.name, in.index - p.slot);
        }
        return "$?";
      case Op::signal:
        return behavior_.signals.info(in.index).name;
      case Op::state_time:
        return "t";
      case Op::time:
        return "time";
      case Op::in_state:
        return fmt::format("in({})", behavior_.states[at(in.index)].path);
      case Op::entry:
        return "entry";
      default:
        return operation(last);
    }
  }

  std::string operation(int last) const {
    const OpInfo info = op_info(code(last).op);
    std::vector<std::string> operands;
    for (int k = info.operands, end = last - 1; k > 0; --k) {
      operands.insert(operands.begin(), words(end));
      end = begin_of(end) - 1;
    }
    if (info.infix) return fmt::format("({} {} {})", operands[0], info.name, operands[1]);
    if (code(last).op == Op::negate || code(last).op == Op::logical_not) {
      return info.name + operands[0];
    }
    return fmt::format("{}({})", info.name, fmt::join(operands, ", "));
  }

  const Behavior& behavior_;
  const EvaluationContext& context_;
};

}  // namespace

std::vector<GuardTerm> guard_terms(const Behavior& behavior, int expression,
                                   const EvaluationContext& context) {
  const Expression& e = behavior.expressions[expression];
  Terms terms(behavior, context);
  terms.split(e.first + e.count - 1);
  return std::move(terms.terms);
}

}  // namespace footfall::behaviors
