// Lookup tables of the statechart, built once at load; see index.h.
#include "behaviors/statechart/index.h"

namespace footfall::behaviors {
namespace {

int size_of(const std::vector<Trigger>& v) { return static_cast<int>(v.size()); }
int size_of(const std::vector<int>& v) { return static_cast<int>(v.size()); }

}  // namespace

ChartIndex::ChartIndex(const Chart& chart) {
  const int count = static_cast<int>(chart.states.size());
  for (int s = 0; s < count; ++s) {
    const StateInfo& state = chart.states[static_cast<std::size_t>(s)];
    const auto add = [&](bool with_event) {
      const int first = size_of(triggers);
      for (int t = state.transitions.first; t < state.transitions.end(); ++t) {
        const TransitionInfo& info = chart.transitions[static_cast<std::size_t>(t)];
        if (info.has_event == with_event) triggers.push_back({t, info.guard, info.after >= 0});
      }
      return Range{first, size_of(triggers) - first};
    };
    eventless.push_back(add(false));
    on_event.push_back(add(true));
    const auto outer = [&](const std::vector<int>& firsts) {
      return state.parent < 0 ? -1 : firsts[static_cast<std::size_t>(state.parent)];
    };
    first_eventless.push_back(eventless.back().count > 0 ? s : outer(first_eventless));
    first_on_event.push_back(on_event.back().count > 0 ? s : outer(first_on_event));
    state_timers.push_back({size_of(timers), 0});
    for (int t = state.transitions.first; t < state.transitions.end(); ++t) {
      if (chart.transitions[static_cast<std::size_t>(t)].after >= 0) timers.push_back(t);
    }
    state_timers.back().count = size_of(timers) - state_timers.back().first;
    own_histories.push_back({size_of(histories), 0});
    for (int c = s + 1; c < state.end; c = chart.states[static_cast<std::size_t>(c)].end) {
      if (chart.states[static_cast<std::size_t>(c)].history >= 0) histories.push_back(c);
    }
    own_histories.back().count = size_of(histories) - own_histories.back().first;
  }
}

}  // namespace footfall::behaviors
