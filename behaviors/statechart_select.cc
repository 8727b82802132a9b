// Which transitions are taken: SCXML's selectTransitions and removeConflictingTransitions.
#include <cmath>

#include "behaviors/statechart.h"

namespace footfall::behaviors {

void Statechart::select(int event) noexcept {
  selected_.clear();
  for (const int atomic : atomic_list_) {
    int chosen = -1;
    for (int s = atomic; s >= 0 && chosen < 0; s = state(s).parent) {
      const Range own = state(s).transitions;
      for (int t = own.first; t < own.end() && chosen < 0; ++t) {
        if (enabled(t, event)) chosen = t;
      }
    }
    if (chosen >= 0) add_if_not_preempted(chosen);
  }
}

bool Statechart::enabled(int transition, int event) const noexcept {
  const TransitionInfo& t = chart_.transitions[idx(transition)];
  if (t.has_event != (event >= 0)) return false;
  if (t.has_event && !chart_.matches(transition, event)) return false;
  if (t.after >= 0) {
    const std::int64_t due = deadlines_[idx(transition)];
    if (due < 0 || context_.tick < due) return false;
    if (!t.has_event && timer_taken_[idx(transition)] != 0) return false;
  }
  if (t.guard < 0) return true;
  const double value = evaluate(chart_.expressions, t.guard, context_);
  return std::isfinite(value) && value != 0.0;
}

// What history targets stand for now; other targets stand for themselves.
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
// child); then a descendant's transition beats its ancestor's, else the earlier one wins.
void Statechart::add_if_not_preempted(int transition) noexcept {
  const int mine = domain(transition);
  const int source = chart_.transitions[idx(transition)].source;
  std::size_t kept = 0;
  for (const int other : selected_) {
    if (other == transition) return;
  }
  for (const int other : selected_) {
    const int theirs = domain(other);
    const bool conflict = mine >= 0 && theirs >= 0 &&
                          (mine == theirs || chart_.is_descendant(mine, theirs) ||
                           chart_.is_descendant(theirs, mine));
    if (conflict && !chart_.is_descendant(source, chart_.transitions[idx(other)].source)) return;
  }
  for (const int other : selected_) {
    const int theirs = domain(other);
    const bool conflict = mine >= 0 && theirs >= 0 &&
                          (mine == theirs || chart_.is_descendant(mine, theirs) ||
                           chart_.is_descendant(theirs, mine));
    if (!conflict) selected_[kept++] = other;
  }
  selected_.resize(kept);  // never grows: no allocation
  selected_.push_back(transition);
}

}  // namespace footfall::behaviors
