// Order of the structural checks, and functions that they share; see structure.h.
#include "behaviors/check/structure/structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/index.h"

namespace footfall::behaviors {
namespace {

bool is_variable(const Behavior& behavior, int slot) {
  const int parameter = behavior.parameter_of_slot(slot);
  return parameter >= 0 && behavior.parameters[at(parameter)].variable;
}

}  // namespace

int exit_domain(const Chart& chart, const TransitionInfo& transition) {
  if (transition.domain >= 0 || transition.targets.count == 0) return transition.domain;
  return chart.domain_of(transition, &chart.targets[at(transition.targets.first)],
                         transition.targets.count);
}

bool never_true(const LoadContext& context, int transition) {
  const auto value = context.constant_value(context.behavior.transitions[at(transition)].guard);
  return value && !(*value < 0.0 || *value > 0.0);  // NaN is false, too
}

bool always_true(const LoadContext& context, int transition) {
  const int guard = context.behavior.transitions[at(transition)].guard;
  return guard < 0 || (context.constant_value(guard) && !never_true(context, transition));
}

bool same_expression(const Chart& chart, int a, int b) {
  if (a < 0 || b < 0) return a == b;
  const auto& pool = chart.expressions;
  const auto begin = [&](int e) { return pool.code.begin() + pool[e].first; };
  return pool[a].count == pool[b].count &&
         std::equal(begin(a), begin(a) + pool[a].count, begin(b),
                    [](const Instruction& x, const Instruction& y) {
                      return x.op == y.op && x.index == y.index && x.value == y.value;
                    });
}

std::optional<double> planned_value(const LoadContext& context, int expression) {
  if (expression < 0) return std::nullopt;
  const ExpressionPool& pool = context.behavior.expressions;
  const Expression& e = pool[expression];
  for (int k = e.first; k < e.first + e.count; ++k) {
    const Instruction& i = pool.code[at(k)];
    if (i.op > Op::entry || i.op == Op::constant) continue;
    if (i.op != Op::parameter || is_variable(context.behavior, i.index)) return std::nullopt;
  }
  EvaluationContext first;
  first.parameters = context.behavior.values.data();
  return evaluate(pool, expression, first);
}

std::optional<std::int64_t> planned_ticks(const LoadContext& context, int expression) {
  const auto seconds = planned_value(context, expression);
  const std::int64_t ticks = seconds ? periods_of(*seconds, context.behavior.rate_mhz) : -1;
  return ticks < 0 ? std::nullopt : std::optional(ticks);
}

std::string place_of(const LoadContext& context, core::Mark mark) {
  return fmt::format("{}:{}:{}", context.diagnostics.file(mark.file), mark.line, mark.column);
}

void Findings::look(core::Mark mark, bool found, std::string text) {
  const auto [place, fresh] =
      by_place_.try_emplace({mark.file, mark.line, mark.column}, findings_.size());
  if (fresh) {
    findings_.push_back({mark, found, std::move(text)});
  } else if (!found) {
    findings_[place->second].found = false;
  }
}

std::vector<Findings::Finding> Findings::found() const {
  std::vector<Finding> out;
  std::copy_if(findings_.begin(), findings_.end(), std::back_inserter(out),
               [](const Finding& finding) { return finding.found; });
  return out;
}

const core::YamlNode& transition_keys(const LoadContext& context, int transition) {
  const core::YamlNode* node = context.transition_nodes[at(transition)];
  const int source = context.behavior.transitions[at(transition)].source;
  return node != nullptr ? *node : context.sources[at(source)]->keys;
}

bool made_by_mirror(const LoadContext& context, int transition) {
  const core::YamlNode& keys = transition_keys(context, transition);
  const core::YamlNode* on = keys.find("on");  // the template's name is the only position available
  return on != nullptr && on->mark.line == keys.mark.line && on->mark.column == keys.mark.column;
}

void check_structure(LoadContext& context) {
  check_events(context);
  check_unused(context);
  check_mirror(context);
  check_times(context);
  check_timing(context);
  const Reach reach = find_reach(context);
  check_reachability(context, reach);
  check_transitions(context, reach);
  check_shadowed(context, reach);
  check_loops(context, reach);
  check_event_loops(context, reach);
  if (context.behavior.has_robot) check_contacts(context, reach);
}

}  // namespace footfall::behaviors
