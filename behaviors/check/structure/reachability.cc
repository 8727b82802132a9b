// States that are never entered, and states that are never exited.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/check/structure/structure.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

// Adds all states that can be entered after those in `pending`.
void spread(const LoadContext& context, std::vector<int> pending, std::vector<char>& entered) {
  const Chart& chart = context.behavior;
  EntrySet entry(chart);
  for (const int s : pending) entered[at(s)] = 1;
  while (!pending.empty()) {
    const Range own = chart.states[at(pending.back())].transitions;
    pending.pop_back();
    for (int t = own.first; t < own.end(); ++t) {
      const TransitionInfo& transition = chart.transitions[at(t)];
      if (transition.targets.count == 0 || never_true(context, t)) continue;
      for (const int s : entry.of(transition)) {
        if (entered[at(s)] == 0) pending.push_back(s);
        entered[at(s)] = 1;
      }
    }
  }
}

// States that are never entered although their parents are, and which of them leads to which.
class UnreachableCheck {
 public:
  UnreachableCheck(LoadContext& context, const Reach& reach)
      : context_(context), chart_(context.behavior), entered_(reach.with_safe) {}

  // A state reached from another unreachable one is reported with it: one missing transition gives
  // one warning.
  void report() {
    for (int s = 1; s < count(); ++s) {
      if (entered_[at(s)] == 0 && entered_[at(state(s).parent)] != 0) lost_.push_back(s);
    }
    find_led();
    std::stable_partition(lost_.begin(), lost_.end(), [&](int s) { return led_[at(s)] == 0; });
    Findings findings;
    std::vector<char> explained = entered_;
    for (const int s : lost_) {
      if (explained[at(s)] != 0) continue;
      const std::vector<char> before = explained;
      spread(context_, {s}, explained);
      findings.look(state(s).mark, true,
                    fmt::format("'{}' is never entered: nothing leads to it{}{}", state(s).path,
                                meant(s), followers(s, before, explained)));
    }
    for (int s = 1; s < count(); ++s) {  // another instance of the same text may be reachable
      if (entered_[at(s)] != 0) findings.look(state(s).mark, false, {});
    }
    for (const auto& finding : findings.found()) {
      context_.warning(finding.mark, "unreachable", finding.text);
    }
  }

 private:
  int count() const { return static_cast<int>(chart_.states.size()); }
  const StateInfo& state(int s) const { return chart_.states[at(s)]; }

  // A sibling that is entered and has a similar name.
  std::string meant(int s) {
    constexpr int kGuesses = 100;  // each one compares with every sibling
    if (++guesses_ > kGuesses) return {};
    std::vector<std::string> names;
    const int parent = state(s).parent;
    for (int c = parent + 1; c < state(parent).end; c = state(c).end) {
      if (entered_[at(c)] != 0) names.push_back(state(c).name);
    }
    return core::did_you_mean(state(s).name, names);
  }

  // The outermost unreachable state that contains this one.
  int lost_around(int s) const {
    while (entered_[at(state(s).parent)] == 0) s = state(s).parent;
    return s;
  }

  void find_led() {
    led_.assign(chart_.states.size(), 0);
    EntrySet entry(chart_);
    for (int t = 0; t < static_cast<int>(chart_.transitions.size()); ++t) {
      const TransitionInfo& transition = chart_.transitions[at(t)];
      if (entered_[at(transition.source)] != 0 || transition.targets.count == 0) continue;
      if (never_true(context_, t)) continue;
      const int from = lost_around(transition.source);
      for (const int s : entry.of(transition)) {
        if (s != from) led_[at(s)] = 1;
      }
    }
  }

  std::string followers(int s, const std::vector<char>& before,
                        const std::vector<char>& explained) const {
    std::string names;
    for (const int other : lost_) {
      if (other == s || before[at(other)] != 0 || explained[at(other)] == 0) continue;
      names += fmt::format("{} '{}'", names.empty() ? "; nor, then, to" : ",", state(other).path);
    }
    return names;
  }

  LoadContext& context_;
  const Chart& chart_;
  const std::vector<char>& entered_;
  std::vector<int> lost_;
  std::vector<char> led_;  // by state: another unreachable state leads to it
  int guesses_ = 0;
};

// States without exit. The state of `safe`, and states reached only from it, may be such.
class DeadEndCheck {
 public:
  DeadEndCheck(LoadContext& context, const Reach& reach)
      : context_(context), chart_(context.behavior), reach_(reach) {}

  void report() {
    find_escapes();
    count_places();
    Findings findings;
    for (int s = 0; s < count(); ++s) {
      if (!on_the_way(s) || !is_dead_end(s)) continue;
      findings.look(state(s).mark, true,
                    fmt::format("'{}' can never be left: give it a transition, or `type: final` "
                                "if this is where it ends",
                                state(s).path));
    }
    for (const auto& finding : findings.found()) {
      context_.warning(finding.mark, "dead-end", finding.text);
    }
  }

 private:
  int count() const { return static_cast<int>(chart_.states.size()); }
  const StateInfo& state(int s) const { return chart_.states[at(s)]; }

  bool on_the_way(int s) const {
    if (reach_.from_start[at(s)] == 0) return false;
    if (chart_.safe_transition < 0) return true;
    const int safe =
        chart_.targets[at(chart_.transitions[at(chart_.safe_transition)].targets.first)];
    return s != safe && !chart_.is_descendant(s, safe);
  }

  // A state whose transitions only run actions is intended to stay; a region with a single state
  // cannot end either.
  bool is_dead_end(int s) const {
    return state(s).kind == StateKind::atomic && state(s).transitions.count == 0 &&
           !can_be_left(s) && places_[at(region_of(s))] > 1;
  }

  bool exits(int t) const {
    return chart_.transitions[at(t)].targets.count > 0 && !never_true(context_, t);
  }

  // By parallel state: a transition inside one of its regions exits all of them.
  void find_escapes() {
    escapes_.assign(chart_.states.size(), 0);
    for (int t = 0; t < static_cast<int>(chart_.transitions.size()); ++t) {
      const int source = chart_.transitions[at(t)].source;
      if (!exits(t) || t == chart_.safe_transition || reach_.with_safe[at(source)] == 0) continue;
      const int domain = exit_domain(chart_, chart_.transitions[at(t)]);
      for (int p = state(source).parent; p >= domain; p = state(p).parent) {
        if (state(p).kind == StateKind::parallel) escapes_[at(p)] = 1;
        if (p == 0) break;
      }
    }
  }

  bool can_be_left(int s) const {
    for (int a = s; a >= 0; a = state(a).parent) {
      const Range own = state(a).transitions;
      for (int t = own.first; t < own.end(); ++t) {
        if (exits(t)) return true;
      }
      if (escapes_[at(a)] != 0) return true;
    }
    return false;
  }

  // The region that contains a state, else the root.
  int region_of(int s) const {
    while (s > 0 && state(state(s).parent).kind != StateKind::parallel) s = state(s).parent;
    return s;
  }

  // By region, the number of its states.
  void count_places() {
    places_.assign(chart_.states.size(), 0);
    for (int s = 0; s < count(); ++s) {
      const StateKind kind = state(s).kind;
      if (!on_the_way(s) || kind == StateKind::compound || state(s).history >= 0) continue;
      ++places_[at(region_of(s))];
    }
  }

  LoadContext& context_;
  const Chart& chart_;
  const Reach& reach_;
  std::vector<char> escapes_;
  std::vector<int> places_;
};

}  // namespace

void EntrySet::clear() {
  for (const int s : list_) entered_[at(s)] = 0;
  list_.clear();
}

const std::vector<int>& EntrySet::of(Range targets, int ancestor) {
  clear();
  add_targets(targets, ancestor);
  return list_;
}

const std::vector<int>& EntrySet::of(const TransitionInfo& transition) {
  return of(transition.targets, exit_domain(chart_, transition));
}

const std::vector<int>& EntrySet::of_start() {
  clear();
  add_default(0);
  return list_;
}

void EntrySet::add(int state) {
  if (entered_[at(state)] != 0) return;
  entered_[at(state)] = 1;
  list_.push_back(state);
}

void EntrySet::add_default(int state) {
  add(state);
  if (entered_[at(state)] == 2) return;
  entered_[at(state)] = 2;
  const StateInfo& info = chart_.states[at(state)];
  if (info.history >= 0) {
    add_targets(info.initial, info.parent);
  } else if (info.kind == StateKind::compound) {
    add_targets(info.initial, state);
  } else if (info.kind == StateKind::parallel) {
    for (int c = state + 1; c < info.end; c = chart_.states[at(c)].end) {
      if (chart_.states[at(c)].history < 0) add_default(c);
    }
  }
}

bool EntrySet::holds_target(int state, Range targets) const {
  for (int k = targets.first; k < targets.end(); ++k) {
    const int target = chart_.targets[at(k)];
    if (target == state || chart_.is_descendant(target, state)) return true;
  }
  return false;
}

void EntrySet::add_targets(Range targets, int ancestor) {
  for (int k = targets.first; k < targets.end(); ++k) {
    const int target = chart_.targets[at(k)];
    add_default(target);
    for (int p = chart_.states[at(target)].parent; p >= 0 && p != ancestor;
         p = chart_.states[at(p)].parent) {
      add(p);
      const StateInfo& info = chart_.states[at(p)];
      if (info.kind != StateKind::parallel) continue;
      for (int c = p + 1; c < info.end; c = chart_.states[at(c)].end) {
        if (chart_.states[at(c)].history < 0 && !holds_target(c, targets)) add_default(c);
      }
    }
  }
}

Reach find_reach(const LoadContext& context) {
  const Chart& chart = context.behavior;
  EntrySet entry(chart);
  Reach reach;
  reach.from_start.assign(chart.states.size(), 0);
  spread(context, entry.of_start(), reach.from_start);
  reach.with_safe = reach.from_start;
  if (chart.safe_transition >= 0) {
    const Range safe = chart.transitions[at(chart.safe_transition)].targets;
    spread(context, entry.of(safe, 0), reach.with_safe);
  }
  return reach;
}

void check_reachability(LoadContext& context, const Reach& reach) {
  UnreachableCheck(context, reach).report();
  DeadEndCheck(context, reach).report();
}

}  // namespace footfall::behaviors
