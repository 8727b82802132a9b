// One function for each operation and combination of operands; see program.h.
#pragma once

#include "behaviors/expression/expression.h"

namespace footfall::behaviors {

// Operations added by lowering.
enum class Unary : std::uint8_t {
  load,   // loads the operand
  store,  // stores the accumulator in stored[right]
  truth,  // 1 or 0; a non-finite value stays non-finite
  negate,
  logical_not,
  absolute,
  square_root,
  sine,
  cosine,
  exponential,
  logarithm,
  square,
  cube,
};
inline constexpr int kUnaries = 13;

// Steps that only control the sequence.
enum class Control : std::uint8_t {
  finish,        // ends; the accumulator is the value
  unless_true,   // jumps by `left` steps unless the accumulator is 1
  unless_false,  // jumps by `left` steps unless the accumulator is 0
  choose,        // 1: continues; 0: jumps by `left`; else jumps by `right`
  jump,          // jumps by `left`
};

Kernel control_kernel(Control control);
Kernel unary_kernel(Unary op, Source source);
// Kernel of a binary operation, with both operands from the first kPairSources sources; not for
// greater and greater_equal: exchange the operands.
Kernel binary_kernel(Op op, Source left, Source right);
// select: accumulator ? left : right; clamp: the accumulator between left and right.
Kernel ternary_kernel(Op op, Source left, Source right);
// Operation following a product: left + right*accumulator, left - right*accumulator, or
// right*accumulator - left, each of the two operations rounded.
enum class Scaled : std::uint8_t { plus, minus, from };
Kernel scaled_kernel(Scaled op, Source left, Source right);
// Combines the accumulator with an operation of left and right: accumulator outer (left inner
// right); nullptr unless outer is + - * / and inner + - *.
Kernel nested_kernel(Op outer, Op inner, Source left, Source right);
// `and` or `or` of the accumulator (0, 1 or not finite) with a comparison of left and right.
Kernel guard_kernel(Op logic, Op comparison, Source left, Source right);

}  // namespace footfall::behaviors
