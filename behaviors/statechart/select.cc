// Selects transitions: SCXML's selectTransitions and removeConflictingTransitions.
#include <algorithm>
#include <cmath>

#include "behaviors/statechart/statechart.h"

namespace footfall::behaviors {

// Every active atomic state, in document order, selects the first enabled transition of itself or
// of its nearest ancestor with one. Conditions have no side effects, so each state is tested only
// once in a selection, even if several atomic states share an ancestor.
void Statechart::select(int event) noexcept {
  selected_.clear();
  candidates_.clear();
  ++selection_;
  for (const int atomic : atomic_list_) consider(atomic, event);
  if (candidates_.size() > 1) {
    remove_conflicting();
  } else {
    for (const int t : candidates_) selected_.push_back(t);
  }
}

void Statechart::consider(int s, int event) noexcept {
  const std::vector<int>& first = event < 0 ? index_.first_eventless : index_.first_on_event;
  const std::vector<Range>& ranges = event < 0 ? index_.eventless : index_.on_event;
  for (int at = first[idx(s)]; at >= 0;) {
    if (asked_[idx(at)] == selection_) return;
    asked_[idx(at)] = selection_;
    const Range own = ranges[idx(at)];
    for (int k = own.first; k < own.end(); ++k) {
      const Trigger& trigger = index_.triggers[idx(k)];
      if (!enabled(trigger, event)) continue;
      candidates_.push_back(trigger.transition);
      return;
    }
    const int parent = state(at).parent;
    at = parent < 0 ? -1 : first[idx(parent)];
  }
}

bool Statechart::enabled(const Trigger& trigger, int event) const noexcept {
  const int t = trigger.transition;
  if (event >= 0 && !chart_.matches(t, event)) return false;
  if (trigger.timed) {
    const std::int64_t due = deadlines_[idx(t)];
    if (due < 0 || context_.tick < due) return false;
    if (event < 0 && timer_taken_[idx(t)] != 0) return false;
  }
  if (trigger.guard < 0) return true;
  const double value = evaluate(chart_.expressions, trigger.guard, context_);
  const bool holds = std::isfinite(value) && value != 0.0;
  guard_outcomes_[idx(t)] |= holds ? 2U : 1U;
  return holds;
}

// Replaces history targets by the states that they restore; other targets are unchanged.
int Statechart::effective_targets(const TransitionInfo& transition, int* out) const noexcept {
  int count = 0;
  for (int k = transition.targets.first; k < transition.targets.end(); ++k) {
    const int target = chart_.targets[idx(k)];
    const StateInfo& info = state(target);
    if (info.history < 0) {
      out[count++] = target;
      continue;
    }
    const int stored = history_counts_[idx(info.history)];
    const std::size_t base = idx(info.history) * chart_.states.size();
    for (int i = 0; i < stored; ++i) out[count++] = history_values_[base + idx(i)];
    if (stored > 0) continue;
    for (int i = info.initial.first; i < info.initial.end(); ++i) {
      out[count++] = chart_.targets[idx(i)];
    }
  }
  return count;
}

int Statechart::domain(int transition) const noexcept {
  const TransitionInfo& t = chart_.transitions[idx(transition)];
  if (t.targets.count == 0 || t.domain >= 0) return t.domain;
  const int count = effective_targets(t, target_scratch_.data());
  return chart_.domain_of(t, target_scratch_.data(), count);
}

// Exit sets intersect exactly if one domain contains the other (a domain always has an active
// child); then a descendant's transition has precedence over its ancestor's, otherwise the earlier
// one.
void Statechart::remove_conflicting() noexcept {
  for (const int t1 : candidates_) {
    const int mine = domain(t1);
    const int source = chart_.transitions[idx(t1)].source;
    const auto conflicts = [&](int t2) {
      const int theirs = domain(t2);
      return mine >= 0 && theirs >= 0 &&
             (mine == theirs || chart_.is_descendant(mine, theirs) ||
              chart_.is_descendant(theirs, mine));
    };
    const bool preempted = std::any_of(selected_.begin(), selected_.end(), [&](int t2) {
      return conflicts(t2) && !chart_.is_descendant(source, chart_.transitions[idx(t2)].source);
    });
    if (preempted) continue;
    selected_.erase(std::remove_if(selected_.begin(), selected_.end(), conflicts), selected_.end());
    selected_.push_back(t1);
  }
}

}  // namespace footfall::behaviors
