// Loops sustained by events within one tick: each transition raises, by its actions or by reaching
// a final state, the event that triggers the next one, until `micro_steps` ends them.
//
// The consequences of a transition are simulated with a queue of internal events as at run time, as
// long as no condition, time or parallel region is involved; otherwise nothing is reported.
#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "behaviors/check/structure/structure.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

constexpr int kMaxLooks = 2'000'000;  // transitions tested; beyond, no check (too slow)
constexpr std::size_t kMaxPlayedSteps = 64;
constexpr std::size_t kMaxPlayedQueue = 32;

// State of the machine between two micro steps.
struct Place {
  int leaf = -1;
  std::deque<int> queue;  // internal events
  bool operator==(const Place&) const = default;
};

// A micro step: the transition taken, and the event that triggers it, -1: none.
struct MicroStep {
  int transition = -1;
  int event = -1;
};

class EventLoopCheck {
 public:
  EventLoopCheck(LoadContext& context, const Reach& reach)
      : context_(context), chart_(context.behavior), reach_(reach), entry_(chart_) {}

  void report() {
    for (int leaf = 0; leaf < static_cast<int>(chart_.states.size()); ++leaf) {
      if (state(leaf).kind != StateKind::atomic || reach_.with_safe[at(leaf)] == 0) continue;
      for (int s = leaf; s >= 0; s = state(s).parent) {
        const Range own = state(s).transitions;
        for (int t = own.first; t < own.end(); ++t) {
          if (looks_ < kMaxLooks && !never_true(context_, t)) follow(leaf, t);
        }
      }
    }
    for (const auto& finding : findings_.found()) {
      context_.warning(finding.mark, "possible-loop", finding.text);
    }
  }

 private:
  const StateInfo& state(int s) const { return chart_.states[at(s)]; }
  const TransitionInfo& transition(int t) const { return chart_.transitions[at(t)]; }

  // Follows the path from a leaf by this transition until it ends, becomes uncertain, or closes a
  // loop.
  void follow(int leaf, int first) {
    Place now{leaf, {}};
    std::vector<Place> places;
    std::vector<MicroStep> steps;
    MicroStep step{first, -1};
    while (steps.size() < kMaxPlayedSteps && take(step.transition, now)) {
      steps.push_back(step);
      const auto seen = std::find(places.begin(), places.end(), now);
      if (seen != places.end()) {
        const auto since = seen - places.begin() + 1;
        say({steps.begin() + since, steps.end()}, {seen, places.end()});
        return;
      }
      places.push_back(now);
      if (!next(now, step)) return;
    }
  }

  // The certain next micro step; its event is taken from the queue. False if there is none or it is
  // uncertain.
  bool next(Place& now, MicroStep& step) {
    if (!select(now.leaf, -1, step.transition)) return false;
    step.event = -1;
    while (step.transition < 0) {
      if (now.queue.empty()) return false;
      step.event = now.queue.front();
      now.queue.pop_front();
      if (!select(now.leaf, step.event, step.transition)) return false;
    }
    return true;
  }

  // Finds the transition that an event (-1: none) triggers from a leaf, -1 for none; false if
  // uncertain.
  bool select(int leaf, int event, int& found) {
    found = -1;
    for (int s = leaf; s >= 0; s = state(s).parent) {
      const Range own = state(s).transitions;
      looks_ += own.count;
      for (int t = own.first; t < own.end(); ++t) {
        const TransitionInfo& info = transition(t);
        if (info.has_event != (event >= 0) || never_true(context_, t)) continue;
        if (event >= 0 && !chart_.matches(t, event)) continue;
        if (info.after >= 0 && planned_ticks(context_, info.after).value_or(0) > 0) continue;
        if (info.after >= 0 || !always_true(context_, t)) return false;
        found = t;
        return true;
      }
    }
    return true;
  }

  // Takes a transition; false if the result is uncertain.
  bool take(int t, Place& now) {
    const TransitionInfo& info = transition(t);
    const int domain = exit_domain(chart_, info);
    for (int s = now.leaf; info.targets.count > 0 && s > domain; s = state(s).parent) {
      if (!act(state(s).on_exit, now)) return false;
    }
    if (!act(info.actions, now)) return false;
    if (info.targets.count == 0) return !in_region(now.leaf);
    std::vector<int> entered = entry_.of(info);
    std::sort(entered.begin(), entered.end());
    for (const int s : entered) {
      if (state(s).history >= 0 || state(s).kind == StateKind::parallel) return false;
      if (!act(state(s).on_entry, now)) return false;
      if (state(s).kind == StateKind::final) {
        if (state(s).parent == 0) return false;  // end of the run
        now.queue.push_back(state(state(s).parent).done_event);
      }
      now.leaf = s;
    }
    return !in_region(now.leaf) && now.queue.size() <= kMaxPlayedQueue;
  }

  bool in_region(int s) const {
    while (s >= 0 && state(s).kind != StateKind::parallel) s = state(s).parent;
    return s >= 0;
  }

  // Runs actions; those that may fail (a value out of range, a call) end their list, so the result
  // is uncertain.
  bool act(Range actions, Place& now) const {
    for (int k = actions.first; k < actions.end(); ++k) {
      const ActionInfo& action = chart_.actions[at(k)];
      if (action.kind == ActionKind::call) return false;
      if (action.kind == ActionKind::set && action.min < action.max) return false;
      if (action.kind == ActionKind::raise) now.queue.push_back(action.index);
    }
    return true;
  }

  // `places`: state before each step of the loop. Loops of event-less transitions only are reported
  // elsewhere.
  void say(const std::vector<MicroStep>& steps, const std::vector<Place>& places) {
    if (std::all_of(steps.begin(), steps.end(), [](MicroStep step) { return step.event < 0; }))
      return;
    const auto first = std::min_element(steps.begin(), steps.end(), [](MicroStep a, MicroStep b) {
      return a.transition < b.transition;
    });
    const std::size_t count = steps.size(), start = at(static_cast<int>(first - steps.begin()));
    std::string text;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t step = (start + k) % count;
      text += fmt::format("'{}' -> ", state(places[step].leaf).path);
      if (steps[step].event >= 0)
        text += fmt::format("({}) ", chart_.events[at(steps[step].event)]);
    }
    text += fmt::format(
        "'{}' is a loop that takes no time: its transitions raise the events that "
        "take them; it needs an `after` or a condition that ends it",
        state(places[start].leaf).path);
    findings_.look(transition(first->transition).mark, true, std::move(text));
  }

  LoadContext& context_;
  const Chart& chart_;
  const Reach& reach_;
  EntrySet entry_;
  int looks_ = 0;
  Findings findings_;
};

}  // namespace

void check_event_loops(LoadContext& context, const Reach& reach) {
  const Chart& chart = context.behavior;
  const auto raises = [](const ActionInfo& action) { return action.kind == ActionKind::raise; };
  const auto ends = [&chart](const StateInfo& info) {
    return info.kind == StateKind::final && info.parent > 0;
  };
  if (std::any_of(chart.actions.begin(), chart.actions.end(), raises) ||
      std::any_of(chart.states.begin(), chart.states.end(), ends)) {
    EventLoopCheck(context, reach).report();
  }
}

}  // namespace footfall::behaviors
