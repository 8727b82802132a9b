// Evaluation of compiled expressions, in the tick; see expression.h.
#include "behaviors/expression/expression.h"

namespace footfall::behaviors {
namespace {

int append(ExpressionPool& pool, Instruction instruction, core::Dimension dimension,
           bool constant) {
  return pool.add({instruction}, dimension, false, constant);
}

}  // namespace

double run_program(const Step* first, const EvaluationContext& context) noexcept {
  double stored[kExpressionStack];  // NOLINT: written before it is read
  return first->kernel(first, 0.0, context, stored);
}

int ExpressionPool::add(std::vector<Instruction> postfix, core::Dimension dimension, bool bare,
                        bool constant) {
  Expression expression;
  expression.first = static_cast<int>(code.size());
  expression.count = static_cast<int>(postfix.size());
  expression.dimension = dimension;
  expression.bare = bare;
  expression.constant = constant;
  lower_expression(postfix.data(), expression.count, program, expression);
  code.insert(code.end(), postfix.begin(), postfix.end());
  expressions.push_back(expression);
  return size() - 1;
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
