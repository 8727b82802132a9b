// Conditions that a state without a value of their signals fails; see context.h.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/index.h"
#include "lab/scenario/context.h"

namespace footfall::lab {
namespace {

using behaviors::Behavior;
using behaviors::StateKind;

// The task or internal force whose signals have a value only while it is active; empty for other
// signals. `prefix` becomes `task.` or `internal.`.
std::string owner_of(const std::string& signal, std::string_view& prefix) {
  for (const std::string_view kind : {"task.", "internal."}) {
    if (!signal.starts_with(kind)) continue;
    prefix = kind;
    return signal.substr(kind.size(), signal.find('.', kind.size()) - kind.size());
  }
  return {};
}

bool has(const Behavior& behavior, const behaviors::ControlSpec& control, std::string_view prefix,
         const std::string& name) {
  if (prefix == "internal.") {
    for (int k = control.internals.first; k < control.internals.end(); ++k) {
      const auto instance = at(behavior.internals[at(k)].instance);
      if (behavior.internal_instances[instance] == name) return true;
    }
    return false;
  }
  for (int k = control.tasks.first; k < control.tasks.end(); ++k) {
    if (behavior.task_instances[at(behavior.tasks[at(k)].instance)].name == name) return true;
  }
  return false;
}

// Whether a state is entered on a fault or at the end only, or ends the run.
bool is_out_of_the_way(const Behavior& behavior, int state) {
  const behaviors::StateInfo& info = behavior.states[at(state)];
  if (info.kind == StateKind::final && info.parent == 0) return true;
  if (behavior.safe_transition < 0) return false;
  const behaviors::Range safe = behavior.transitions[at(behavior.safe_transition)].targets;
  for (int k = safe.first; k < safe.end(); ++k) {
    const int target = behavior.targets[at(k)];
    if (state >= target && state < behavior.states[at(target)].end) return true;
  }
  return false;
}

// The control law of an innermost state, nullptr if regions beside it have a part in it.
const behaviors::ControlSpec* control_of(const Behavior& behavior, int state) {
  int index = 0;
  for (int s = state; s >= 0; s = behavior.states[at(s)].parent) {
    if (behavior.states[at(s)].kind == StateKind::parallel) return nullptr;
    index += behavior.states[at(s)].control_weight;
  }
  if (index < 0 || index >= std::ssize(behavior.controls)) return nullptr;
  return &behavior.controls[at(index)];
}

// The paths of the states in which the task or force is not active.
std::vector<std::string> states_without(const Behavior& behavior, std::string_view prefix,
                                        const std::string& name) {
  std::vector<std::string> paths;
  for (int s = 1; s < std::ssize(behavior.states); ++s) {
    const StateKind kind = behavior.states[at(s)].kind;
    if (kind != StateKind::atomic && kind != StateKind::final) continue;
    const behaviors::ControlSpec* control = control_of(behavior, s);
    if (control == nullptr || has(behavior, *control, prefix, name)) continue;
    if (!is_out_of_the_way(behavior, s)) paths.push_back(behavior.states[at(s)].path);
  }
  return paths;
}

// `in()`, `or`, `not` and `? :` may let a condition hold without the value.
bool has_a_way_out(const behaviors::ExpressionPool& pool, int expression) {
  const behaviors::Expression& e = pool[expression];
  for (int k = e.first; k < e.first + e.count; ++k) {
    const behaviors::Op op = pool.code[at(k)].op;
    if (op == behaviors::Op::in_state || op == behaviors::Op::logical_or ||
        op == behaviors::Op::logical_not || op == behaviors::Op::select) {
      return true;
    }
  }
  return false;
}

}  // namespace

void warn_no_value(ScenarioContext& context, const Expectation& expectation, core::Mark mark) {
  const ScenarioDescription& scenario = context.scenario;
  if (scenario.behavior == nullptr || expectation.expression < 0) return;
  // With a window of time the author has chosen where it is judged; within a time once is enough.
  if (expectation.timed || expectation.within) return;
  if (has_a_way_out(scenario.expressions, expectation.expression)) return;
  const behaviors::Expression& e = scenario.expressions[expectation.expression];
  for (int k = e.first; k < e.first + e.count; ++k) {
    const behaviors::Instruction& code = scenario.expressions.code[at(k)];
    if (code.op != behaviors::Op::signal) continue;
    const std::string signal = scenario.signals.info(code.index).name;
    std::string_view prefix;
    const std::string name = owner_of(signal, prefix);
    if (name.empty()) continue;
    const auto without = states_without(*scenario.behavior, prefix, name);
    if (without.empty()) continue;
    const std::string more =
        without.size() > 1 ? fmt::format(" and {} other states", without.size() - 1) : "";
    context.diagnostics.warning(
        mark, "no-value",
        fmt::format("'{}' has no value in '{}'{}, where the condition counts as not so: write "
                    "`not in(STATE) or ...`, or give a time",
                    signal, without.front(), more));
    return;
  }
}

}  // namespace footfall::lab
