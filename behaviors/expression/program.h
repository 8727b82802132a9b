// Execution of expressions in the tick: a list of steps over one number, the accumulator. Lowering
// converts the parser's postfix code to steps at load: constants are folded, a step reads its
// operands from their original location (a signal, a parameter, a constant in the step), and `and`,
// `or`, `? :` jump over operands that are not needed. A step is one function, its kernel, chosen by
// its operation and operands.
#pragma once

#include <cstdint>
#include <vector>

namespace footfall::behaviors {

struct EvaluationContext;
struct Expression;
struct Instruction;
struct Step;

// Location of an operand.
enum class Source : std::uint8_t {
  accumulator,
  stored,  // a stored intermediate result
  constant,
  parameter,
  signal,
  state_time,
  // Only for unary steps:
  time,
  in_state,
  entry,
};
inline constexpr int kSources = 9;
inline constexpr int kPairSources = 6;  // sources of binary steps

// Function of a step. It ends by calling the next one, so a program returns when its last step
// returns. Optimizing compilers turn the call into a jump; otherwise the stack grows with the
// number of steps, bounded by kMaxSteps.
using Kernel = double (*)(const Step* step, double accumulator, const EvaluationContext& context,
                          double* stored) noexcept;

inline constexpr int kMaxSteps = 4096;  // steps of one expression

union StepOperand {
  double value;        // for a constant
  std::int64_t index;  // for other sources, or number of steps to jump
};

struct Step {
  Kernel kernel = nullptr;
  StepOperand left{0.0};
  StepOperand right{0.0};
};

// Runs the steps from `first` to a finishing step; each step runs at most once.
double run_program(const Step* first, const EvaluationContext& context) noexcept;

// Appends the steps for `code` (postfix, `count` instructions that leave one value) to the program
// and sets how `expression` is evaluated.
void lower_expression(const Instruction* code, int count, std::vector<Step>& program,
                      Expression& expression);

}  // namespace footfall::behaviors
