// Bumpless transfer of the statechart from another behavior; see
// behaviors/compiled/take_over_map.h.
#include <algorithm>

#include "behaviors/compiled/take_over_map.h"
#include "behaviors/statechart/statechart.h"

namespace footfall::behaviors {
namespace {
constexpr std::int64_t kUnknown = -2;  // a deadline still to be computed

}  // namespace

void EventQueue::take_over(const EventQueue& old, const std::vector<int>& events) noexcept {
  clear();
  for (int i = 0; i < old.size(); ++i) {
    const int event = events[static_cast<std::size_t>(old.at(i))];
    if (event >= 0) push(event);
  }
}

bool Statechart::has_configuration_of(const Statechart& old,
                                      const TakeOverMap& map) const noexcept {
  return std::ranges::all_of(old.active_list_, [&](int s) { return map.states[idx(s)] >= 0; });
}

void Statechart::take_over(const Statechart& old, const TakeOverMap& map) noexcept {
  context_.tick = old.context_.tick;
  faults_ = old.faults_;
  finished_ = false;
  safe_requested_ = old.safe_requested_;
  recorded_start_ = false;
  steps_ = 0;
  for (auto* list : {&marks_, &taken_, &events_}) list->clear();
  logs_.clear();
  script_requests_.clear();
  internal_.take_over(old.internal_, map.events);
  external_.take_over(old.external_, map.events);
  if (has_configuration_of(old, map)) {
    take_configuration(old, map);
  } else {
    enter_again(old.context_.tick);
  }
  take_histories(old, map);
  for (const int s : active_list_) control_before_[idx(s)] = control_;
}

// Clocks continue. A deadline is kept if its `after` is unchanged; otherwise it is computed from
// the new `after`, counted from the entry.
void Statechart::take_configuration(const Statechart& old, const TakeOverMap& map) noexcept {
  std::ranges::fill(active_, std::uint8_t{0});
  std::ranges::fill(deadlines_, kUnknown);
  std::ranges::fill(timer_taken_, std::uint8_t{0});
  configuration_.clear();
  for (std::size_t s = 0; s < map.states.size(); ++s) {
    if (map.states[s] < 0) continue;
    const std::size_t here = idx(map.states[s]);
    entry_ticks_[here] = old.entry_ticks_[s];
    entry_serials_[here] = old.entry_serials_[s];
    if (old.active_[s] == 0) continue;
    active_[here] = 1;
    configuration_.insert(map.states[s]);
  }
  refresh_lists();
  for (std::size_t t = 0; t < map.transitions.size(); ++t) {
    if (map.transitions[t] < 0) continue;
    const std::size_t here = idx(map.transitions[t]);
    timer_taken_[here] = old.timer_taken_[t];
    if (map.same_after[t] != 0) deadlines_[here] = old.deadlines_[t];
  }
  for (const int s : active_list_) find_deadlines(s, kUnknown);
  std::ranges::replace(deadlines_, kUnknown, std::int64_t{-1});
}

// Restores this chart's last configuration, with new clocks and without running actions.
void Statechart::enter_again(std::int64_t tick) noexcept {
  for (const int s : active_list_) {
    entry_ticks_[idx(s)] = tick;
    ++entry_serials_[idx(s)];
    const Range timers = index_.state_timers[idx(s)];
    for (int k = timers.first; k < timers.end(); ++k) {
      deadlines_[idx(index_.timers[idx(k)])] = kUnknown;
      timer_taken_[idx(index_.timers[idx(k)])] = 0;
    }
    find_deadlines(s, kUnknown);
  }
}

// Computes the `unknown` deadlines of a state, counted from its entry.
void Statechart::find_deadlines(int s, std::int64_t unknown) noexcept {
  const Range timers = index_.state_timers[idx(s)];
  for (int k = timers.first; k < timers.end(); ++k) {
    const std::size_t t = idx(index_.timers[idx(k)]);
    if (deadlines_[t] != unknown) continue;
    const int after = chart_.transitions[t].after;
    const double seconds = evaluate(chart_.expressions, after, context_);
    const std::int64_t periods = periods_of(seconds, chart_.rate_mhz);
    deadlines_[t] = periods < 0 ? -1 : entry_ticks_[idx(s)] + periods;
    if (periods < 0) execution_error(no_time(after, seconds));
  }
}

// A history that contains removed states is dropped as a whole.
void Statechart::take_histories(const Statechart& old, const TakeOverMap& map) noexcept {
  for (std::size_t h = 0; h < map.histories.size(); ++h) {
    if (map.histories[h] < 0) continue;
    const std::size_t from = h * old.chart_.states.size();
    const std::size_t to = idx(map.histories[h]) * chart_.states.size();
    int& count = history_counts_[idx(map.histories[h])];
    count = old.history_counts_[h];
    for (int i = 0; i < old.history_counts_[h]; ++i) {
      const int here = map.states[idx(old.history_values_[from + idx(i)])];
      if (here < 0) count = 0;
      if (count > 0) history_values_[to + idx(i)] = here;
    }
  }
}

}  // namespace footfall::behaviors
