// Loops that events keep going within one tick: each transition raises, by its actions or by
// reaching a final state, the event that takes the next one, until `micro_steps` cuts them off.
//
// What follows a transition is played through, with a queue of internal events as at run time: as
// far as no condition, time or parallel region has a say. Where one has, nothing is said.
#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "behaviors/check/structure/structure.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

constexpr int kMaxLooks = 2'000'000;  // at transitions: beyond, the check is silent, not slow
constexpr std::size_t kMaxPlayedSteps = 64;
constexpr std::size_t kMaxPlayedQueue = 32;

// Where the machine is between two micro steps.
struct Place {
  int leaf = -1;
  std::deque<int> queue;  // internal events
  bool operator==(const Place&) const = default;
};

// A micro step: which transition is taken, and the event that does it, -1: none.
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

  // The way from a leaf by this transition, until it ends, cannot be known, or comes back to where
  // it was.
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

  // The micro step that surely comes next; its event is taken from the queue. False: none, or none
  // that is sure.
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

  // The transition that an event (-1: none) takes from a leaf, -1 for none; false: who knows.
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

  // Takes a transition; false if what comes of it cannot be known.
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
        if (state(s).parent == 0) return false;  // the run ends
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

  // What may fail ends its list: a value out of range, a call.
  bool act(Range actions, Place& now) const {
    for (int k = actions.first; k < actions.end(); ++k) {
      const ActionInfo& action = chart_.actions[at(k)];
      if (action.kind == ActionKind::call) return false;
      if (action.kind == ActionKind::set && action.min < action.max) return false;
      if (action.kind == ActionKind::raise) now.queue.push_back(action.index);
    }
    return true;
  }

  // `places`: before each step of the loop. One of event-less transitions only is reported
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
