// How the tick runs an expression: a list of steps over one number, the accumulator. Lowering turns
// the parser's postfix code into them at load: constants are folded, a step reads its operands
// where they are (a signal, a parameter, a constant in the step), and `and`, `or`, `? :` jump over
// what does not count. A step is one function, its kernel, chosen for its operation and operands.
#pragma once

#include <cstdint>
#include <vector>

namespace footfall::behaviors {

struct EvaluationContext;
struct Expression;
struct Instruction;
struct Step;

// Where an operand is read.
enum class Source : std::uint8_t {
  accumulator,
  stored,  // an intermediate result put aside
  constant,
  parameter,
  signal,
  state_time,
  // Only for steps with one operand:
  time,
  in_state,
  entry,
};
inline constexpr int kSources = 9;
inline constexpr int kPairSources = 6;  // of steps with two operands

// What a step does; it ends by calling the next one, so a run returns when the last has returned.
// Compilers turn that into a jump when they optimise; else the stack grows with the steps, which
// kMaxSteps bounds.
using Kernel = double (*)(const Step* step, double accumulator, const EvaluationContext& context,
                          double* stored) noexcept;

inline constexpr int kMaxSteps = 4096;  // of one expression

union StepOperand {
  double value;        // of a constant
  std::int64_t index;  // of anything else, or steps to jump
};

struct Step {
  Kernel kernel = nullptr;
  StepOperand left{0.0};
  StepOperand right{0.0};
};

// Runs the steps from `first` to the one that finishes; none is run twice.
double run_program(const Step* first, const EvaluationContext& context) noexcept;

// Appends the steps of `code` (postfix, `count` instructions that leave one value) to the program
// and fills in how `expression` is evaluated.
void lower_expression(const Instruction* code, int count, std::vector<Step>& program,
                      Expression& expression);

}  // namespace footfall::behaviors
