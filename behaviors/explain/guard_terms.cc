// Converts postfix code back to text; see guard_terms.h.
#include "behaviors/explain/guard_terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace footfall::behaviors {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct OpInfo {
  int operands = 0;
  const char* name = "";
  bool infix = false;
};

// Operations with written operators; the others are printed by name.
constexpr auto kOps = std::to_array<std::pair<Op, OpInfo>>({
    {Op::negate, {1, "-"}},
    {Op::logical_not, {1, "not "}},
    {Op::add, {2, "+", true}},
    {Op::subtract, {2, "-", true}},
    {Op::multiply, {2, "*", true}},
    {Op::divide, {2, "/", true}},
    {Op::power, {2, "^", true}},
    {Op::less, {2, "<", true}},
    {Op::less_equal, {2, "<=", true}},
    {Op::greater, {2, ">", true}},
    {Op::greater_equal, {2, ">=", true}},
    {Op::equal, {2, "==", true}},
    {Op::not_equal, {2, "!=", true}},
    {Op::logical_and, {2, "and", true}},
    {Op::logical_or, {2, "or", true}},
    {Op::select, {3, "select"}},
    {Op::absolute, {1, "abs"}},
    {Op::minimum, {2, "min"}},
    {Op::maximum, {2, "max"}},
    {Op::clamp, {3, "clamp"}},
    {Op::square_root, {1, "sqrt"}},
    {Op::sine, {1, "sin"}},
    {Op::cosine, {1, "cos"}},
    {Op::arctangent2, {2, "atan2"}},
    {Op::hypotenuse, {2, "hypot"}},
    {Op::exponential, {1, "exp"}},
    {Op::logarithm, {1, "log"}},
});

OpInfo op_info(Op op) {
  const auto found = std::ranges::find(kOps, op, &std::pair<Op, OpInfo>::first);
  return found == kOps.end() ? OpInfo{} : found->second;
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
