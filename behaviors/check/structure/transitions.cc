// Checks of single transitions: conditions that are never true, and regions re-entered implicitly.
#include <fmt/format.h>

#include "behaviors/check/structure/structure.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

core::Mark mark_of(const LoadContext& context, int t, const char* key) {
  const core::YamlNode* node = transition_keys(context, t).find(key);
  return node != nullptr ? node->mark : context.behavior.transitions[at(t)].mark;
}

bool inside(const Chart& chart, const TransitionInfo& transition, int state) {
  for (int k = transition.targets.first; k < transition.targets.end(); ++k) {
    if (!chart.is_descendant(chart.targets[at(k)], state)) return false;
  }
  return true;
}

// Whether the targets define the destination of every region of the parallel state.
bool names_all_regions(const Chart& chart, const TransitionInfo& transition, int parallel) {
  for (int c = parallel + 1; c < chart.states[at(parallel)].end; c = chart.states[at(c)].end) {
    if (chart.states[at(c)].history >= 0) continue;
    bool named = false;
    for (int k = transition.targets.first; k < transition.targets.end(); ++k) {
      const int target = chart.targets[at(k)];
      named = named || target == c || chart.is_descendant(target, c);
    }
    if (!named) return false;
  }
  return true;
}

// The parallel state around source and targets that is exited and re-entered as a whole, -1 if
// none.
int re_entered(const Chart& chart, const TransitionInfo& transition) {
  if (transition.targets.count == 0 || transition.domain < 0) return -1;
  for (int p = transition.source; p >= transition.domain; p = chart.states[at(p)].parent) {
    const bool left = p != transition.domain || p == 0;
    if (chart.states[at(p)].kind == StateKind::parallel && left && inside(chart, transition, p)) {
      return names_all_regions(chart, transition, p) ? -1 : p;
    }
    if (p == 0) break;
  }
  return -1;
}

// docs/behaviors.md 8.2: a parallel state is never a domain.
std::string say_re_entry(const Chart& chart, const TransitionInfo& transition, int parallel) {
  const StateInfo& source = chart.states[at(transition.source)];
  const std::string what = fmt::format("this leaves and re-enters all regions of '{}': ",
                                       chart.states[at(parallel)].path);
  if (source.kind == StateKind::compound && inside(chart, transition, transition.source)) {
    return what + fmt::format("`internal: true` keeps it inside '{}'", source.name);
  }
  if (transition.source == parallel) {
    return what + "give it to the region that it is for, with `internal: true`";
  }
  return what + "only a target inside the source's own region lets the others go on";
}

}  // namespace

void check_transitions(LoadContext& context, const Reach& reach) {
  const Behavior& behavior = context.behavior;
  Findings never, again;
  for (int t = 0; t < static_cast<int>(behavior.transitions.size()); ++t) {
    const TransitionInfo& transition = behavior.transitions[at(t)];
    if (reach.with_safe[at(transition.source)] == 0 || t == behavior.safe_transition) continue;
    if (transition.guard >= 0) {
      never.look(mark_of(context, t, "when"), never_true(context, t),
                 "`when` is never true: this transition is never taken");
    }
    if (made_by_mirror(context, t)) continue;
    const int parallel = re_entered(behavior, transition);
    again.look(mark_of(context, t, "to"), parallel >= 0,
               parallel < 0 ? "" : say_re_entry(behavior, transition, parallel));
  }
  for (const auto& finding : never.found()) {
    context.warning(finding.mark, "never-true", finding.text);
  }
  for (const auto& finding : again.found()) {
    context.warning(finding.mark, "re-entry", finding.text);
  }
}

}  // namespace footfall::behaviors
