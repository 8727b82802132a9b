// `invoke:` of a state: when a planner is asked, and the fallback for a late answer.
#include <fmt/format.h>

#include "behaviors/language/language.h"
#include "behaviors/load/chart/steps.h"
#include "behaviors/load/context.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

int find_planner(LoadContext& context, const core::YamlNode& node) {
  if (!core::expect_scalar(node, "the name of a planner", context.diagnostics)) return -1;
  std::vector<std::string> names;
  for (const PlannerInfo& planner : context.behavior.planners) {
    if (planner.name == node.scalar) return static_cast<int>(names.size());
    names.push_back(planner.name);
  }
  context.error(node.mark, "unknown-planner",
                fmt::format("unknown planner '{}'{}", node.scalar,
                            core::did_you_mean_or_list(node.scalar, names)));
  return -1;
}

// States that can be active at the same time must not ask the same planner: the plans would mix.
void check_asked_once(LoadContext& context, const core::YamlNode& node, const InvokeInfo& invoke) {
  const auto& states = context.behavior.states;
  for (const InvokeInfo& other : context.behavior.invokes) {
    if (other.planner != invoke.planner || other.state == invoke.state) continue;
    if (!active_together(context.behavior, other.state, invoke.state)) continue;
    context.error(node.mark, "parallel-conflict",
                  fmt::format("planner '{}' is invoked by '{}' and by '{}' at once", node.scalar,
                              states[static_cast<std::size_t>(other.state)].path,
                              states[static_cast<std::size_t>(invoke.state)].path));
    return;
  }
}

// A time in the state, or a fraction of its `after`.
void read_at(LoadContext& context, const core::YamlNode& at, const core::YamlNode& keys,
             const ValueScope& scope, InvokeInfo& invoke) {
  const auto quantity = at.is_scalar() ? core::parse_quantity(at.scalar) : std::nullopt;
  if (!quantity || quantity->bare || !(quantity->dimension == core::kNone)) {
    invoke.at = context.compile_time(at, scope);
    return;
  }
  const core::YamlNode* after = keys.find("after");
  if (after == nullptr) {
    context.error(at.mark, "missing-key",
                  fmt::format("'{}' of what? The state has no `after` + `to`", at.scalar));
    return;
  }
  if (quantity->value < 0.0 || quantity->value > 1.0) {
    context.error(at.mark, "out-of-range",
                  fmt::format("expected 0 % to 100 %, got '{}'", at.scalar));
  }
  invoke.at_fraction = quantity->value;
  invoke.after = context.compile_time(*after, scope);
}

void read_with(LoadContext& context, const core::YamlNode& node, const ValueScope& scope,
               InvokeInfo& invoke) {
  const core::YamlNode* with = core::require_key(node, "with", context.diagnostics);
  if (with == nullptr || !core::expect_map(*with, "a map", context.diagnostics)) return;
  core::check_keys(*with, kInvokeWithKeys, context.diagnostics);
  const core::YamlNode* stance = core::require_key(*with, "stance", context.diagnostics);
  const core::YamlNode* swing = core::require_key(*with, "swing", context.diagnostics);
  const core::YamlNode* switch_in = core::require_key(*with, "switch_in", context.diagnostics);
  if (stance != nullptr) invoke.stance = context.require_contact(*stance);
  if (swing != nullptr) invoke.swing = context.require_contact(*swing);
  if (switch_in != nullptr) {
    invoke.switch_in = context.compile_time(*switch_in, scope);
  }
  if (invoke.stance >= 0 && invoke.stance == invoke.swing) {
    context.error(swing->mark, "same-foot", "stance and swing are the same foot");
  }
}

void load_invoke(LoadContext& context, const core::YamlNode& node, int state) {
  if (!core::expect_map(node, "a map with planner and with", context.diagnostics)) return;
  core::check_keys(node, kInvokeKeys, context.diagnostics);
  const core::YamlNode* planner = core::require_key(node, "planner", context.diagnostics);
  if (planner == nullptr) return;
  InvokeInfo invoke;
  invoke.state = state;
  invoke.mark = node.mark;
  invoke.planner = find_planner(context, *planner);
  if (invoke.planner >= 0) check_asked_once(context, *planner, invoke);
  ValueScope scope;
  scope.state = state;
  const core::YamlNode& keys = context.sources[static_cast<std::size_t>(state)]->keys;
  invoke.at_mark = node.mark;
  if (const auto* at = node.find("at")) {
    invoke.at_mark = at->mark;
    read_at(context, *at, keys, scope, invoke);
  } else {
    invoke.at = context.behavior.expressions.add_constant(0.0, core::kTime);
  }
  if (const auto* every = node.find("every")) {
    invoke.every = context.compile_time(*every, scope, {.positive = true});
  }
  if (const auto* deadline = node.find("deadline")) {
    invoke.deadline = context.compile_time(*deadline, scope);
  }
  if (const auto* late = node.find("on_late")) {
    const auto choice = core::read_choice(*late, kOnLate, context.diagnostics);
    invoke.closed_form = choice && *choice == 1;
    if (invoke.deadline < 0) {
      context.warning(late->mark, "no-effect",
                      "`on_late` without `deadline`: nothing is ever late");
    }
  }
  read_with(context, node, scope, invoke);
  context.behavior.invokes.push_back(invoke);
}

}  // namespace

void load_invokes(LoadContext& context) {
  for (std::size_t s = 0; s < context.sources.size(); ++s) {
    const core::YamlNode* list = context.sources[s]->keys.find("invoke");
    if (list == nullptr || !core::expect_sequence(*list, "a list", context.diagnostics)) continue;
    const int first = static_cast<int>(context.behavior.invokes.size());
    for (const core::YamlNode& item : list->items) load_invoke(context, item, static_cast<int>(s));
    context.behavior.states[s].invokes = {
        first, static_cast<int>(context.behavior.invokes.size()) - first};
  }
}

}  // namespace footfall::behaviors
