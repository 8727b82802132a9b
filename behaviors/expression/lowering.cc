// Converts postfix code to steps in one pass, with a stack of the locations of values; see
// program.h. A value is read from its original location as long as possible; of computed values,
// the last one is in the accumulator, the others are stored.
#include <cmath>

#include "behaviors/expression/writer.h"

namespace footfall::behaviors {
namespace {

// A leaf that a binary step can read.
bool is_pair_leaf(const Instruction& i) { return i.op <= Op::state_time; }

bool is_comparison(Op op) { return op >= Op::less && op <= Op::not_equal; }

int operands_of(Op op) {
  if (op <= Op::entry) return 0;
  switch (op) {
    case Op::select:
    case Op::clamp:
      return 3;
    case Op::negate:
    case Op::logical_not:
    case Op::absolute:
    case Op::square_root:
    case Op::sine:
    case Op::cosine:
    case Op::exponential:
    case Op::logarithm:
      return 1;
    default:
      return 2;
  }
}

Unary unary_of(Op op) {
  switch (op) {
    case Op::negate:
      return Unary::negate;
    case Op::logical_not:
      return Unary::logical_not;
    case Op::absolute:
      return Unary::absolute;
    case Op::square_root:
      return Unary::square_root;
    case Op::sine:
      return Unary::sine;
    case Op::cosine:
      return Unary::cosine;
    case Op::exponential:
      return Unary::exponential;
    default:
      return Unary::logarithm;
  }
}

Value leaf_value(const Instruction& i) {
  Value value;
  value.operand.index = i.index;
  switch (i.op) {
    case Op::constant:
      value.source = Source::constant;
      value.operand.value = i.value;
      value.logical = i.value == 0.0 || i.value == 1.0;
      break;
    case Op::parameter:
      value.source = Source::parameter;
      break;
    case Op::signal:
      value.source = Source::signal;
      break;
    case Op::state_time:
      value.source = Source::state_time;
      break;
    case Op::time:
      value.source = Source::time;
      break;
    case Op::in_state:
      value.source = Source::in_state;
      value.logical = true;
      break;
    default:
      value.source = Source::entry;
      break;
  }
  return value;
}

class Lowering {
 public:
  Lowering(const Instruction* code, int count, std::vector<Step>& program)
      : code_(code), count_(static_cast<std::size_t>(count)), write_(program) {}

  // Returns the location of the value: the accumulator if steps were needed.
  Value lower() {
    find_branches();
    for (std::size_t k = 0; k < count_; ++k) {
      if (before_[k].op >= 0) begin_operand(before_[k]);
      if (!guarded(k + 1)) lower_instruction(k);
    }
    return stack_.back();
  }

  void finish(const Value& value) {
    if (!value.in_accumulator()) write_.unary(Unary::load, value);
    write_.control(Control::finish);
  }

 private:
  // A conditionally evaluated operand: the second or third operand of `op`.
  struct Branch {
    int op = -1;
    int operand = 0;
  };

  const Instruction& at(std::size_t k) const { return code_[k]; }
  bool guarded(std::size_t k) const { return k < count_ && guards_[k]; }

  // Finds the first instruction of each conditional operand.
  void find_branches() {
    before_.assign(count_, {});
    jump_.assign(count_, 0);
    leave_.assign(count_, 0);
    jumps_.assign(count_, false);
    guards_.assign(count_, false);
    std::vector<std::size_t> starts;
    for (std::size_t k = 0; k < count_; ++k) {
      const Op op = at(k).op;
      const auto operands = static_cast<std::size_t>(operands_of(op));
      if (operands == 0) {
        starts.push_back(k);
        continue;
      }
      const std::size_t* own = starts.data() + starts.size() - operands;
      const int index = static_cast<int>(k);
      if (op == Op::logical_and || op == Op::logical_or) {
        const bool leaf = own[1] + 1 == k && is_pair_leaf(at(own[1]));
        guards_[k] = own[1] + 3 == k && is_pair_leaf(at(k - 3)) && is_pair_leaf(at(k - 2)) &&
                     is_comparison(at(k - 1).op);
        jumps_[k] = !leaf && !guards_[k];
        if (!leaf) before_[own[1]] = {index, 1};
      } else if (op == Op::select) {
        const bool leaves = own[1] + 1 == own[2] && own[2] + 1 == k && is_pair_leaf(at(own[1])) &&
                            is_pair_leaf(at(own[2]));
        jumps_[k] = !leaves;
        if (!leaves) before_[own[1]] = {index, 1};
        if (!leaves) before_[own[2]] = {index, 2};
      }
      starts.resize(starts.size() - operands + 1);  // the result starts where operand 1 starts
    }
  }

  // Moves the accumulator to a slot.
  void spill() {
    for (std::size_t slot = 0; slot < stack_.size(); ++slot) {
      if (stack_[slot].in_accumulator()) put_aside(stack_[slot], slot);
    }
  }
  void put_aside(Value& value, std::size_t slot) {
    write_.store(static_cast<std::int64_t>(slot));
    value.source = Source::stored;
    value.operand.index = static_cast<std::int64_t>(slot);
  }

  void push_result(bool logical) {
    Value result;
    result.logical = logical;
    stack_.push_back(result);
  }
  Value pop() {
    const Value top = stack_.back();
    stack_.pop_back();
    return top;
  }
  void push_constant(double value) { stack_.push_back(leaf_value({Op::constant, 0, value})); }

  // Pops the top into the accumulator, as 0, 1 or non-finite if `truth`.
  void take_top(bool truth) {
    const Value top = pop();
    if (top.in_accumulator() && (!truth || top.logical)) return;
    spill();
    write_.unary(truth && !top.logical ? Unary::truth : Unary::load, top);
  }

  // The first operand of a jumping operation (or the second one of `? :`) is complete.
  void begin_operand(Branch branch) {
    const auto op = static_cast<std::size_t>(branch.op);
    if (branch.operand == 2) {
      take_top(false);
      leave_[op] = write_.control(Control::jump);
      write_.at(jump_[op]).left.index = write_.land(jump_[op]);
      return;
    }
    take_top(true);
    if (guards_[op]) return push_result(true);
    jump_[op] = write_.control(at(op).op == Op::logical_and  ? Control::unless_true
                               : at(op).op == Op::logical_or ? Control::unless_false
                                                             : Control::choose);
  }

  void end_jump(std::size_t k) {
    const bool choice = at(k).op == Op::select;
    take_top(!choice);
    Step& jump = write_.at(jump_[k]);
    (choice ? jump.right : jump.left).index = write_.land(jump_[k]);
    if (choice) write_.at(leave_[k]).left.index = write_.land(leave_[k]);
    push_result(!choice);
  }

  void lower_instruction(std::size_t k) {
    const Instruction& i = at(k);
    if (jumps_[k]) return end_jump(k);
    if (guards_[k]) return lower_guard(i.op, at(k - 1).op);
    switch (operands_of(i.op)) {
      case 0:
        stack_.push_back(leaf_value(i));
        if (is_pair_leaf(i)) return;
        take_top(false);
        return push_result(i.op == Op::in_state);
      case 1:
        return lower_unary(unary_of(i.op));
      case 2:
        return lower_binary(i.op);
      default:
        return lower_ternary(i.op);
    }
  }

  void lower_unary(Unary op) {
    const Value a = pop();
    if (a.is_constant()) return push_constant(fold(op, a));
    spill();
    write_.unary(op, a);
    push_result(op == Unary::logical_not);
  }

  // Kernels exist only for `<` and `<=`.
  static void mirror(Op& op, Value& left, Value& right) {
    if (op != Op::greater && op != Op::greater_equal) return;
    std::swap(left, right);
    op = op == Op::greater ? Op::less : Op::less_equal;
  }

  // `and`, `or` with a comparison whose operands need no steps, as one step; the left side is in
  // the accumulator.
  void lower_guard(Op logic, Op comparison) {
    Value right = pop();
    Value left = pop();
    pop();
    mirror(comparison, left, right);
    write_.pair(guard_kernel(logic, comparison, left.source, right.source), left, right);
    push_result(true);
  }

  void lower_binary(Op op) {
    Value right = pop();
    Value left = pop();
    mirror(op, left, right);
    if (op == Op::power && right.is_constant() &&
        (right.operand.value == 2.0 || right.operand.value == 3.0)) {
      stack_.push_back(left);
      return lower_unary(right.operand.value == 2.0 ? Unary::square : Unary::cube);
    }
    if (left.is_constant() && right.is_constant()) return push_constant(fold(op, left, right));
    spill();
    write_.binary(op, left, right);
    push_result(is_comparison(op) || op == Op::logical_and || op == Op::logical_or);
  }

  void lower_ternary(Op op) {
    Value right = pop();
    Value left = pop();
    const Value first = pop();
    if (right.in_accumulator()) put_aside(right, stack_.size() + 2);
    if (left.in_accumulator()) put_aside(left, stack_.size() + 1);
    if (!first.in_accumulator()) {
      spill();
      write_.unary(Unary::load, first);
    }
    write_.pair(ternary_kernel(op, left.source, right.source), left, right);
    push_result(false);
  }

  const Instruction* code_;
  std::size_t count_;
  StepWriter write_;
  std::vector<Value> stack_;
  std::vector<Branch> before_;      // by instruction: branches that begin there
  std::vector<bool> jumps_;         // by operation: whether it jumps
  std::vector<bool> guards_;        // by operation: whether it absorbs the comparison before it
  std::vector<std::size_t> jump_;   // by operation: its first jump
  std::vector<std::size_t> leave_;  // by operation: the jump after the second operand of `? :`
};

}  // namespace

namespace {

bool is_product_of_parameter(const Instruction* code, int count) {
  if (count != 3 || code[2].op != Op::multiply) return false;
  return (code[0].op == Op::constant && code[1].op == Op::parameter) ||
         (code[0].op == Op::parameter && code[1].op == Op::constant);
}

bool is_square_of_signal(const Instruction* code, int count) {
  return count == 3 && code[0].op == Op::signal && code[1].op == Op::constant &&
         code[1].value == 2.0 && code[2].op == Op::power;
}

// The forms beside `step` of expressions that are one step; false: it has none.
bool compute_in_line(const Instruction* code, int count, Expression& expression) {
  if (count == 1 && code[0].op == Op::state_time) {
    expression.form = Expression::Form::state_time;
    expression.index = code[0].index;
  } else if (is_product_of_parameter(code, count)) {
    const bool constant_first = code[0].op == Op::constant;
    expression.form = Expression::Form::scaled;
    expression.value = code[constant_first ? 0 : 1].value;
    expression.index = code[constant_first ? 1 : 0].index;
  } else if (is_square_of_signal(code, count)) {
    expression.form = Expression::Form::square;
    expression.index = code[0].index;
  } else {
    return false;
  }
  return true;
}

}  // namespace

void lower_expression(const Instruction* code, int count, std::vector<Step>& program,
                      Expression& expression) {
  const std::size_t first = program.size();
  Lowering lowering(code, count, program);
  Value value = lowering.lower();
  if (expression.constant && value.in_accumulator()) {
    lowering.finish(value);
    value = leaf_value({Op::constant, 0, run_program(program.data() + first, {})});
  }
  expression.program = static_cast<int>(first);
  if (value.source == Source::constant) {
    expression.form = Expression::Form::constant;
    expression.value = value.operand.value;
  } else if (value.source == Source::parameter || value.source == Source::signal) {
    expression.form =
        value.source == Source::signal ? Expression::Form::signal : Expression::Form::parameter;
    expression.index = static_cast<int>(value.operand.index);
  } else {
    lowering.finish(value);
    if (!compute_in_line(code, count, expression) && program.size() == first + 2) {
      expression.form = Expression::Form::step;
    }
    return;
  }
  program.resize(first);  // no steps needed
}

}  // namespace footfall::behaviors
