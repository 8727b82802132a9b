// Writes the steps of an expression: chooses kernels, and joins neighbouring steps where one kernel
// does both. Load time only; see program.h.
#pragma once

#include <vector>

#include "behaviors/expression/kernels.h"

namespace footfall::behaviors {

// Where a value lies between two steps.
struct Value {
  Source source = Source::accumulator;
  StepOperand operand{0.0};
  bool logical = false;  // 0, 1 or not finite

  bool in_accumulator() const { return source == Source::accumulator; }
  bool is_constant() const { return source == Source::constant; }
};

// The value of an operation on constants.
double fold(Unary op, const Value& a);
double fold(Op op, const Value& left, const Value& right);

class StepWriter {
 public:
  explicit StepWriter(std::vector<Step>& program) : program_(program) {}

  void unary(Unary op, const Value& a);
  // Of any operation with two operands but greater and greater_equal.
  void binary(Op op, const Value& left, const Value& right);
  // A kernel of two operands as it is.
  void pair(Kernel kernel, const Value& left, const Value& right);
  // The accumulator into a place of its own.
  void store(std::int64_t slot);
  // The place of a new control step; its jumps are set later, by land().
  std::size_t control(Control control);
  // What has been written ends here for a jump, so it stays as it is; steps from `from` to here.
  std::int64_t land(std::size_t from);
  Step& at(std::size_t place) { return program_[place]; }
  std::size_t size() const { return program_.size(); }

 private:
  // Lengths of the program mean something only as long as it grows.
  void forget();
  bool join_product(Op op, const Value& left, const Value& right);
  bool join_nested(Op op, const Value& left, const Value& right);

  // The last step, if it was of a kind that can be joined with the next: `size` is the length of
  // the program then, -1 once a jump ends there.
  struct Last {
    std::size_t size = static_cast<std::size_t>(-1);
    Op op = Op::constant;
    Value left, right;
  };

  std::vector<Step>& program_;
  Last product_;  // accumulator times `right`
  Last stored_;   // the accumulator was stored in `left`
  Last nested_;   // stored in the step before; then op of what needs no steps
};

}  // namespace footfall::behaviors
