// Values of expressions before a run; see static_values.h.
#include "behaviors/compiled/static_values.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace footfall::behaviors {
Dependence dependence_of(const Behavior& behavior, int expression) {
  Dependence found;
  if (expression < 0) return found;
  const Expression& e = behavior.expressions[expression];
  for (int i = e.first; i < e.first + e.count; ++i) {
    const Instruction& step = behavior.expressions.code[at(i)];
    if (step.op == Op::signal || step.op == Op::state_time || step.op == Op::time ||
        step.op == Op::in_state) {
      found.measured = true;
    } else if (step.op == Op::entry) {
      found.entry = true;
    } else if (step.op == Op::parameter) {
      const int index = behavior.parameter_of_slot(step.index);
      if (index < 0) continue;
      found.variable |= behavior.parameters[at(index)].variable;
      auto& list = found.parameters;
      if (std::find(list.begin(), list.end(), index) == list.end()) list.push_back(index);
    }
  }
  return found;
}

StaticValues::StaticValues(const Behavior& behavior)
    : behavior_(behavior),
      parameters_(behavior.values),
      entry_ticks_(behavior.states.size(), 0),
      active_(behavior.states.size(), 0) {}

std::optional<double> StaticValues::of(int expression, double entry) const {
  if (expression < 0) return std::nullopt;
  const std::vector<double> entries(core::kMaxAxes, entry);
  EvaluationContext context;
  context.signals = behavior_.signals.values();
  context.parameters = parameters_.data();
  context.entry_ticks = entry_ticks_.data();
  context.active = active_.data();
  context.entry = entries.data();
  context.period = behavior_.period();
  const double value = evaluate(behavior_.expressions, expression, context);
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace footfall::behaviors
