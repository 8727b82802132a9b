// Computes the entered states: SCXML's computeEntrySet, addDescendantStatesToEnter and
// addAncestorStatesToEnter, with one bit a state. Recursion is bounded by the depth of the chart.
#include "behaviors/statechart/statechart.h"

namespace footfall::behaviors {

void Statechart::compute_entries(int transition) noexcept {
  const TransitionInfo& t = chart_.transitions[idx(transition)];
  if (t.targets.count == 0) return;
  const int ancestor = domain(transition);
  for (int k = t.targets.first; k < t.targets.end(); ++k) {
    add_descendants(chart_.targets[idx(k)]);
  }
  const int count = effective_targets(t, target_scratch_.data());
  for (int k = 0; k < count; ++k) add_ancestors(target_scratch_[idx(k)], ancestor);
  // A parallel root is its own domain: its other regions were exited and are entered again.
  if (ancestor == 0 && state(0).kind == StateKind::parallel) add_regions(0);
}

void Statechart::add_targets(Range targets, int ancestor) noexcept {
  for (int k = targets.first; k < targets.end(); ++k) add_descendants(chart_.targets[idx(k)]);
  for (int k = targets.first; k < targets.end(); ++k) {
    add_ancestors(chart_.targets[idx(k)], ancestor);
  }
}

void Statechart::add_descendants(int s) noexcept {
  const StateInfo& info = state(s);
  if (info.history >= 0) {
    const int stored = history_counts_[idx(info.history)];
    const std::size_t base = idx(info.history) * chart_.states.size();
    for (int i = 0; i < stored; ++i) add_descendants(history_values_[base + idx(i)]);
    for (int i = 0; i < stored; ++i) add_ancestors(history_values_[base + idx(i)], info.parent);
    if (stored == 0) add_targets(info.initial, info.parent);
    return;
  }
  entering_.insert(s);
  if (info.kind == StateKind::compound) add_targets(info.initial, s);
  if (info.kind == StateKind::parallel) add_regions(s);
}

void Statechart::add_ancestors(int s, int ancestor) noexcept {
  for (int a = state(s).parent; a > ancestor; a = state(a).parent) {
    entering_.insert(a);
    if (state(a).kind == StateKind::parallel) add_regions(a);
  }
}

// Adds the regions of a parallel state in which no state is to be entered yet.
void Statechart::add_regions(int parallel) noexcept {
  for (int child = parallel + 1; child < state(parallel).end; child = state(child).end) {
    if (state(child).history >= 0) continue;
    if (!entering_.any_in(child + 1, state(child).end)) add_descendants(child);
  }
}

}  // namespace footfall::behaviors
