// Transitions in document order; the timed `after` + `to` of a state comes last.
#include <fmt/format.h>

#include "behaviors/language/language.h"
#include "behaviors/load/chart/steps.h"
#include "behaviors/load/context.h"

namespace footfall::behaviors {
namespace {

void finish_domain(LoadContext& context, TransitionInfo& transition) {
  const auto& targets = context.behavior.targets;
  for (int k = transition.targets.first; k < transition.targets.end(); ++k) {
    const int target = targets[static_cast<std::size_t>(k)];
    if (context.behavior.states[static_cast<std::size_t>(target)].history >= 0) return;
  }
  if (transition.targets.count == 0) return;
  transition.domain = context.behavior.domain_of(
      transition, &targets[static_cast<std::size_t>(transition.targets.first)],
      transition.targets.count);
}

// `node`: the transition's map, nullptr for a state's own `after` + `to`.
void add_transition(LoadContext& context, TransitionInfo transition, const core::YamlNode* node) {
  finish_domain(context, transition);
  context.transition_nodes.push_back(node);
  context.behavior.transitions.push_back(std::move(transition));
}

void load_transition(LoadContext& context, int state, const core::YamlNode& node) {
  if (!core::expect_map(node, "a transition (a map with on, when or after)", context.diagnostics)) {
    return;
  }
  core::check_keys(node, kTransitionKeys, context.diagnostics);
  const core::YamlNode* on = node.find("on");
  const core::YamlNode* when = node.find("when");
  const core::YamlNode* after = node.find("after");
  const core::YamlNode* to = node.find("to");
  if (on == nullptr && when == nullptr && after == nullptr) {
    context.error(node.mark, "missing-key", "a transition needs at least one of on, when, after");
  }
  // With `on` alone it absorbs the event: outer states do not get it. Without an event nothing
  // would ever be absorbed.
  if (on == nullptr && to == nullptr && node.find("do") == nullptr) {
    context.error(node.mark, "missing-key",
                  "a transition without `on` needs `to` or `do`; only one with `on` may absorb an "
                  "event and do nothing");
  }
  TransitionInfo transition;
  transition.mark = node.mark;
  transition.source = state;
  const int index = static_cast<int>(context.behavior.transitions.size());
  ValueScope scope;
  scope.state = state;
  if (on != nullptr) {
    transition.has_event = true;
    load_patterns(context, state, *on, index);
  }
  if (when != nullptr) transition.guard = context.compile_condition(*when, scope);
  if (after != nullptr) {
    transition.after = context.compile_time(*after, scope, {.guard = transition.guard});
  }
  if (to != nullptr) transition.targets = load_targets(context, state, *to);
  if (const auto* internal = node.find("internal")) {
    transition.internal = core::read_bool(*internal, context.diagnostics).value_or(false);
  }
  if (const auto* actions = node.find("do")) {
    transition.actions = load_actions(context, *actions, state);
  }
  if (const auto* reason = node.find("reason")) {
    if (core::check_doc(*reason, context.diagnostics)) transition.reason = reason->scalar;
  }
  add_transition(context, std::move(transition), &node);
}

// The state's own duration: `after` + `to`.
void load_timed(LoadContext& context, int state) {
  const core::YamlNode* after = context.keys_of(state).find("after");
  const core::YamlNode* to = context.keys_of(state).find("to");
  if (after == nullptr && to == nullptr) return;
  if (after == nullptr || to == nullptr) {
    if (core::has_nearly(context.keys_of(state), after == nullptr ? "after" : "to")) return;
    context.error(
        (after == nullptr ? to : after)->mark, "missing-key",
        after == nullptr ? "`to` needs `after` beside it" : "`after` needs `to` beside it");
    return;
  }
  TransitionInfo transition;
  transition.mark = after->mark;
  transition.source = state;
  ValueScope scope;
  scope.state = state;
  transition.after = context.compile_time(*after, scope);
  transition.targets = load_targets(context, state, *to);
  add_transition(context, std::move(transition), nullptr);
}

void load_state(LoadContext& context, int state) {
  const core::YamlNode& keys = context.keys_of(state);
  const auto actions = [&](const char* key) {
    const core::YamlNode* node = keys.find(key);
    return node == nullptr ? Range{} : load_actions(context, *node, state);
  };
  const Range entry = actions("on_entry");
  const Range exit = actions("on_exit");
  const int first = static_cast<int>(context.behavior.transitions.size());
  const core::YamlNode* list = keys.find("transitions");
  if (list != nullptr &&
      core::expect_sequence(*list, "a list of transitions", context.diagnostics)) {
    for (const core::YamlNode& item : list->items) load_transition(context, state, item);
  }
  load_timed(context, state);
  StateInfo& info = context.behavior.states[static_cast<std::size_t>(state)];
  info.on_entry = entry;
  info.on_exit = exit;
  info.transitions = {first, static_cast<int>(context.behavior.transitions.size()) - first};
}

void load_safe(LoadContext& context) {
  const core::YamlNode* safe = context.machine.keys.find("safe");
  if (safe == nullptr) return;
  TransitionInfo transition;
  transition.mark = safe->mark;
  transition.has_event = true;  // no event matches: taken only on request
  transition.targets = load_targets(context, 0, *safe);
  transition.reason = "safe";
  if (transition.targets.count == 0) return;
  context.behavior.safe_transition = static_cast<int>(context.behavior.transitions.size());
  add_transition(context, std::move(transition), nullptr);
  context.behavior.transitions.back().domain = 0;
}

}  // namespace

void load_transitions(LoadContext& context) {
  const int count = static_cast<int>(context.behavior.states.size());
  for (int state = 0; state < count; ++state) load_state(context, state);
  load_safe(context);
}

}  // namespace footfall::behaviors
