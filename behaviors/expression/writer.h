// Writes the steps of an expression: chooses kernels, and combines neighbouring steps if one kernel
// computes both. Load time only; see program.h.
#pragma once

#include <vector>

#include "behaviors/expression/kernels.h"

namespace footfall::behaviors {

// Location of a value between two steps.
struct Value {
  Source source = Source::accumulator;
  StepOperand operand{0.0};
  bool logical = false;  // 0, 1 or non-finite

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
  // Writes any binary operation except greater and greater_equal.
  void binary(Op op, const Value& left, const Value& right);
  // Writes a binary kernel without combining it.
  void pair(Kernel kernel, const Value& left, const Value& right);
  // Stores the accumulator in its own slot.
  void store(std::int64_t slot);
  // Index of a new control step; its jumps are set later by land().
  std::size_t control(Control control);
  // Makes the current end a jump target, so that earlier steps must not change; returns the
  // distance from step `from`.
  std::int64_t land(std::size_t from);
  Step& at(std::size_t place) { return program_[place]; }
  std::size_t size() const { return program_.size(); }

 private:
  // Forgets combinable steps; recorded lengths are valid only while the program grows.
  void forget();
  bool join_product(Op op, const Value& left, const Value& right);
  bool join_nested(Op op, const Value& left, const Value& right);

  // The last step, if it can be combined with the next one: `size` is the length of the program at
  // that time, -1 once a jump ends there.
  struct Last {
    std::size_t size = static_cast<std::size_t>(-1);
    Op op = Op::constant;
    Value left, right;
  };

  std::vector<Step>& program_;
  Last product_;  // accumulator times `right`
  Last stored_;   // the accumulator was stored in `left`
  Last nested_;   // stored in the step before; then an operation whose operands need no steps
};

}  // namespace footfall::behaviors
