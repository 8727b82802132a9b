// Chooses kernels for steps, and combines neighbouring steps; see writer.h.
#include "behaviors/expression/writer.h"

#include <utility>

namespace footfall::behaviors {

namespace {

Step step_of(Kernel kernel, const Value& left, const Value& right = {}) {
  return {kernel, left.operand, right.operand};
}

// Executes one step.
double run_step(const Step& step) {
  const Step steps[] = {step, {control_kernel(Control::finish), {0.0}, {0.0}}};
  return run_program(steps, {});
}

}  // namespace

double fold(Unary op, const Value& a) { return run_step(step_of(unary_kernel(op, a.source), a)); }

double fold(Op op, const Value& left, const Value& right) {
  return run_step(step_of(binary_kernel(op, left.source, right.source), left, right));
}

void StepWriter::unary(Unary op, const Value& a) {
  program_.push_back(step_of(unary_kernel(op, a.source), a));
}

void StepWriter::pair(Kernel kernel, const Value& left, const Value& right) {
  program_.push_back(step_of(kernel, left, right));
}

void StepWriter::store(std::int64_t slot) {
  Step step;
  step.kernel = unary_kernel(Unary::store, Source::accumulator);
  step.right.index = slot;
  program_.push_back(step);
  stored_.size = size();
  stored_.left.operand.index = slot;
}

std::size_t StepWriter::control(Control control) {
  Step step;
  step.kernel = control_kernel(control);
  program_.push_back(step);
  return size() - 1;
}

void StepWriter::forget() { product_ = stored_ = nested_ = {}; }

std::int64_t StepWriter::land(std::size_t from) {
  forget();
  return static_cast<std::int64_t>(size() - from);
}

void StepWriter::binary(Op op, const Value& left, const Value& right) {
  if (join_nested(op, left, right) || join_product(op, left, right)) return;
  const bool fresh = !left.in_accumulator() && !right.in_accumulator();
  const bool after_store = stored_.size == size();
  pair(binary_kernel(op, left.source, right.source), left, right);
  if (op == Op::multiply && left.in_accumulator() != right.in_accumulator()) {
    product_ = {size(), op, {}, left.in_accumulator() ? right : left};
  }
  if (after_store && fresh) nested_ = {size(), op, left, right};
}

// Combines a sum or difference with the product just computed from the accumulator.
bool StepWriter::join_product(Op op, const Value& left, const Value& right) {
  if ((op != Op::add && op != Op::subtract) || product_.size != size()) return false;
  const bool first = left.in_accumulator();
  if (first == right.in_accumulator()) return false;
  program_.pop_back();
  const Value& other = first ? right : left;
  const Scaled scaled = op == Op::add ? Scaled::plus : first ? Scaled::from : Scaled::minus;
  pair(scaled_kernel(scaled, other.source, product_.right.source), other, product_.right);
  forget();
  return true;
}

// Combines a op1 (b op2 c): a need not be stored before the bracket is evaluated.
bool StepWriter::join_nested(Op op, const Value& left, const Value& right) {
  if (nested_.size != size() || left.source != Source::stored || !right.in_accumulator() ||
      left.operand.index != stored_.left.operand.index) {
    return false;
  }
  const Kernel kernel = nested_kernel(op, nested_.op, nested_.left.source, nested_.right.source);
  if (kernel == nullptr) return false;
  program_.resize(size() - 2);
  pair(kernel, nested_.left, nested_.right);
  forget();
  return true;
}

}  // namespace footfall::behaviors
