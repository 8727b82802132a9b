// Expressions of the behavior language: compiled at load to flat postfix code and lowered to steps
// that the tick runs without allocation. The compiler checks dimensions; callers must handle values
// that are not finite (division by zero, log of a negative number).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/expression/parameter.h"
#include "behaviors/expression/program.h"
#include "core/signal_table.h"
#include "core/units/units.h"

namespace footfall::behaviors {

inline constexpr int kExpressionStack = 32;  // maximum number of intermediate values

enum class Op : std::uint8_t {
  constant,    // value
  parameter,   // parameters[index]
  signal,      // signals[index]
  state_time,  // s since state `index` was entered
  time,        // s since start
  in_state,    // 1 while state `index` is active
  entry,       // entry[index]: start value of the task's reference
  negate,
  logical_not,
  add,
  subtract,
  multiply,
  divide,
  power,
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  logical_and,
  logical_or,
  select,
  absolute,
  minimum,
  maximum,
  clamp,
  square_root,
  sine,
  cosine,
  arctangent2,
  hypotenuse,
  exponential,
  logarithm,
};

struct Instruction {
  Op op = Op::constant;
  std::int32_t index = 0;
  double value = 0.0;
};

// One compiled expression: a range of the pool's code, and how the tick evaluates it.
struct Expression {
  int first = 0;
  int count = 0;
  core::Dimension dimension;
  bool bare = false;      // numbers without unit only: adopted the expected dimension
  bool constant = false;  // has the same value in every tick

  // What is most frequent is computed in line: the call of a step's function costs more than it.
  enum class Form : std::uint8_t {
    constant,
    parameter,
    signal,
    state_time,  // `t` of a state
    scaled,      // a parameter times a constant
    square,      // of a signal
    step,
    program,
  };
  Form form = Form::program;
  int index = 0;       // parameter slot, signal index or state
  int program = 0;     // its first step in the pool's program
  double value = 0.0;  // of the constant
};

// All expressions of a behavior, by index.
struct ExpressionPool {
  std::vector<Instruction> code;
  std::vector<Step> program;
  std::vector<Expression> expressions;

  const Expression& operator[](int index) const {
    return expressions[static_cast<std::size_t>(index)];
  }
  int size() const { return static_cast<int>(expressions.size()); }
  // Adds an expression in postfix code.
  int add(std::vector<Instruction> postfix, core::Dimension dimension, bool bare, bool constant);
  // Adds a constant.
  int add_constant(double value, core::Dimension dimension);
  // Adds a signal.
  int add_signal(int signal, core::Dimension dimension);
  // Adds a parameter slot.
  int add_parameter(int slot, core::Dimension dimension);
};

// Inputs of an expression in a tick.
struct EvaluationContext {
  const double* signals = nullptr;
  const double* parameters = nullptr;
  const std::int64_t* entry_ticks = nullptr;  // by state
  const std::uint8_t* active = nullptr;       // by state
  const double* entry = nullptr;              // by axis of the task
  std::int64_t tick = 0;
  double period = 1e-3;  // s
};

// The value; not finite if a part that contributes to it is not. Comparisons and logic give 0 or 1.
inline double evaluate(const ExpressionPool& pool, int expression,
                       const EvaluationContext& context) noexcept {
  const Expression& e = pool[expression];
  // Not in the switch, whose jump through a table costs as much as they do.
  if (e.form == Expression::Form::state_time) {
    return static_cast<double>(context.tick - context.entry_ticks[e.index]) * context.period;
  }
  if (e.form == Expression::Form::scaled) return e.value * context.parameters[e.index];
  if (e.form == Expression::Form::square) {
    const double signal = context.signals[e.index];
    return signal * signal;
  }
  switch (e.form) {
    case Expression::Form::constant:
      return e.value;
    case Expression::Form::parameter:
      return context.parameters[e.index];
    case Expression::Form::signal:
      return context.signals[e.index];
    case Expression::Form::step: {  // no intermediate results
      const Step* step = pool.program.data() + e.program;
      return step->kernel(step, 0.0, context, nullptr);
    }
    default:
      return run_program(pool.program.data() + e.program, context);
  }
}

struct Statistic;

// Names available to an expression.
struct ExpressionScope {
  const core::SignalTable* signals = nullptr;
  const std::vector<ParameterInfo>* parameters = nullptr;
  int state = -1;  // state whose clock is `t`; -1: no `t`
  // Index of a state by its (partial) name; -1 and a reason otherwise.
  std::function<int(std::string_view name, std::string& why)> find_state;
  const std::vector<std::string>* entry_axes = nullptr;            // axis names for `entry.AXIS`
  int entry_axis = -1;                                             // axis of a plain `entry`
  core::Dimension entry_dimension;                                 // dimension of the task's axes
  const std::vector<core::Dimension>* entry_dimensions = nullptr;  // for each axis, if they differ
  // A statistic of one signal, or of its magnitude, over a run (expectations only): the index of
  // the signal that holds it, -1 if unsupported.
  std::function<int(const Statistic& statistic, bool magnitude, int signal)> find_statistic;
};

// Position and reason of an error; `offset` counts bytes from the start of the text.
struct ExpressionError {
  int offset = 0;
  std::string id;
  std::string text;
};

// Compiles `text` (without a leading `=`) and appends it to the pool. `expected` is checked if
// given; a number without unit adopts the required dimension. Returns -1 and fills `error` on
// failure; fills it, too, if the text is valid and cannot have a value (`no-value`).
int compile_expression(std::string_view text, const ExpressionScope& scope,
                       std::optional<core::Dimension> expected, ExpressionPool& pool,
                       ExpressionError& error);

}  // namespace footfall::behaviors
