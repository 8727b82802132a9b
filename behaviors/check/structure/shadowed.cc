// Transitions that are never taken, because another one has precedence whenever they are enabled.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/check/structure/structure.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

constexpr int kLookBack = 200;  // transitions of one state; beyond, no check (too slow)

// Whether every event that matches `second` matches `first`.
bool event_covers(const std::string& first, std::string second) {
  if (first == second) return true;
  if (second == "*") return false;
  if (second.ends_with(".*")) second.resize(second.size() - 2);
  return Chart::event_matches(first, second);
}

class ShadowCheck {
 public:
  ShadowCheck(LoadContext& context, const Reach& reach)
      : context_(context), chart_(context.behavior), reach_(reach) {
    patterns_.resize(chart_.transitions.size());
    for (const EventPattern& pattern : chart_.patterns) {
      patterns_[at(pattern.transition)].push_back(pattern.text);
    }
    for (int s = 0; s < static_cast<int>(chart_.states.size()); ++s) {
      const StateKind kind = state(s).kind;
      const bool leaf = kind == StateKind::atomic || kind == StateKind::final;
      if (leaf && reach_.with_safe[at(s)] != 0) leaves_.push_back(s);
    }
  }

  void report() {
    Findings findings;
    for (int t = 0; t < static_cast<int>(chart_.transitions.size()); ++t) {
      if (t == chart_.safe_transition || reach_.with_safe[at(transition(t).source)] == 0) continue;
      if (never_true(context_, t) || made_by_mirror(context_, t)) continue;
      const int own = in_own_state(t);
      const int inner = own < 0 ? in_inner_states(t) : -1;
      findings.look(transition(t).mark, own >= 0 || inner >= 0, say(own, inner));
    }
    for (const auto& finding : findings.found()) {
      context_.warning(finding.mark, "shadowed", finding.text);
    }
  }

 private:
  const StateInfo& state(int s) const { return chart_.states[at(s)]; }
  const TransitionInfo& transition(int t) const { return chart_.transitions[at(t)]; }

  std::string say(int own, int inner) const {
    if (own >= 0) {
      return fmt::format("this transition is never taken: the one at {} is, whenever this could be",
                         place_of(context_, transition(own).mark));
    }
    if (inner < 0) return {};
    return fmt::format("this transition is never taken: every state inside takes its own, as at {}",
                       place_of(context_, transition(inner).mark));
  }

  bool covers_events(int first, int second) const {
    if (!transition(first).has_event) {  // event-less transitions precede those with events
      const bool waits = transition(first).after >= 0;
      return transition(first).targets.count > 0 && !(waits && transition(second).has_event);
    }
    if (!transition(second).has_event) return false;
    const auto& wide = patterns_[at(first)];
    return std::all_of(
        patterns_[at(second)].begin(), patterns_[at(second)].end(), [&](const std::string& event) {
          return std::any_of(wide.begin(), wide.end(),
                             [&](const auto& pattern) { return event_covers(pattern, event); });
        });
  }

  // An `after` of the same state that never expires later. Without event it is taken once per
  // entry, so it must also exit the state.
  bool covers_time(int first, int second) const {
    const TransitionInfo &a = transition(first), &b = transition(second);
    if (a.after < 0) return true;
    if (a.source != b.source || b.after < 0) return false;
    if (!a.has_event && (a.targets.count == 0 || exit_domain(chart_, a) == a.source)) return false;
    if (same_expression(chart_, a.after, b.after)) return true;
    const auto early = context_.constant_value(a.after), late = context_.constant_value(b.after);
    return early && late && *early <= *late;
  }

  // Whether `first` is enabled whenever `second` is.
  bool covers(int first, int second) const {
    const bool guard = always_true(context_, first) ||
                       (!never_true(context_, first) &&
                        same_expression(chart_, transition(first).guard, transition(second).guard));
    return guard && covers_events(first, second) && covers_time(first, second);
  }

  int in_own_state(int t) const {
    const Range own = state(transition(t).source).transitions;
    const int from = std::max(own.first, t - kLookBack);
    for (int other = from; other < std::min(own.end(), t + kLookBack); ++other) {
      const bool goes_before =
          other < t || (!transition(other).has_event && transition(t).has_event);
      if (other != t && goes_before && covers(other, t)) return other;
    }
    return -1;
  }

  // The transition with precedence in the first leaf below; -1 unless every leaf has one.
  int in_inner_states(int t) const {
    const int source = transition(t).source;
    int example = -1;
    auto leaf = std::lower_bound(leaves_.begin(), leaves_.end(), source + 1);
    for (; leaf != leaves_.end() && *leaf < state(source).end; ++leaf) {
      const int found = between(*leaf, source, t);
      if (found < 0) return -1;
      if (example < 0) example = found;
    }
    return example;
  }

  int between(int leaf, int source, int t) const {
    for (int s = leaf; s != source; s = state(s).parent) {
      const Range own = state(s).transitions;
      for (int other = own.first; other < std::min(own.end(), own.first + kLookBack); ++other) {
        if (covers(other, t)) return other;
      }
    }
    return -1;
  }

  LoadContext& context_;
  const Chart& chart_;
  const Reach& reach_;
  std::vector<std::vector<std::string>> patterns_;  // by transition
  std::vector<int> leaves_;                         // reachable leaves
};

}  // namespace

void check_shadowed(LoadContext& context, const Reach& reach) {
  ShadowCheck(context, reach).report();
}

}  // namespace footfall::behaviors
