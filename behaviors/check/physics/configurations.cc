// Control configurations and their successors; see configurations.h.
#include "behaviors/check/physics/configurations.h"

#include <algorithm>
#include <optional>
#include <set>

#include "core/index.h"

namespace footfall::behaviors {
namespace {

constexpr std::size_t kMaxPairs = 4096;  // limit of control pairs for one transition
constexpr int kMaxPassed = 32;           // maximum number of states passed through in one tick

// Possible sums of control weights below a state, each with one of its atomic states.
using Sums = std::map<int, int>;

class Walker {
 public:
  explicit Walker(const Behavior& behavior) : b_(behavior), below_(behavior.states.size()) {
    for (std::size_t s = behavior.states.size(); s-- > 0;) fill_below(static_cast<int>(s));
  }

  const StateInfo& state(int s) const { return b_.states[at(s)]; }
  const Sums& below(int s) const { return below_[at(s)]; }
  Sums with_weight(int s, const Sums& sums) const {
    Sums out;
    for (const auto& [sum, leaf] : sums) out[sum + state(s).control_weight] = leaf;
    return out;
  }
  static Sums crossed(const Sums& a, const Sums& b) {
    Sums out;
    for (const auto& [x, leaf] : a) {
      for (const auto& entry : b) out.emplace(x + entry.first, leaf);
    }
    return out;
  }

  // Sums over the states strictly below `top` while `s` is active, from those of the subtree at
  // `s`.
  Sums above(int s, int top, Sums sums) const {
    sums = with_weight(s, sums);
    for (int p = state(s).parent; p >= 0; s = p, p = state(p).parent) {
      if (state(p).kind == StateKind::parallel) sums = crossed(sums, other_regions(p, s));
      if (p == top) break;
      sums = with_weight(p, sums);
    }
    return sums;
  }
  // Sums over `top`, its ancestors and their other regions.
  Sums outside(int top) const { return above(top, -1, {{0, top}}); }

  // Enters `s` for these targets, and default states elsewhere. Source: W3C SCXML 1.0, Appendix D,
  // addDescendantStatesToEnter.
  void enter(int s, const std::vector<int>& targets, std::vector<int>& active) const {
    active.push_back(s);
    enter_children(s, targets, active);
  }
  void enter_children(int s, std::vector<int> targets, std::vector<int>& active) const {
    if (state(s).kind == StateKind::parallel) {
      for (int c = s + 1; c < state(s).end; c = state(c).end) {
        if (state(c).history < 0) enter(c, targets, active);
      }
      return;
    }
    if (state(s).kind != StateKind::compound) return;
    int child = child_towards(s, targets);
    for (int tries = 0; tries < 2 && (child < 0 || state(child).history >= 0); ++tries) {
      targets = targets_of(child >= 0 && tries == 0 ? state(child).initial : state(s).initial);
      child = child_towards(s, targets);
    }
    if (child >= 0 && state(child).history < 0) enter(child, targets, active);
  }
  std::vector<int> targets_of(const Range& range) const {
    return {b_.targets.begin() + range.first, b_.targets.begin() + range.end()};
  }
  int weight(const std::vector<int>& active) const {
    int sum = 0;
    for (const int s : active) sum += state(s).control_weight;
    return sum;
  }

 private:
  void fill_below(int s) {
    Sums& sums = below_[at(s)];
    const bool parallel = state(s).kind == StateKind::parallel;
    if (parallel) sums = {{0, s}};
    for (int c = s + 1; c < state(s).end; c = state(c).end) {
      if (state(c).history >= 0) continue;
      const Sums child = with_weight(c, below(c));
      if (parallel) {
        const bool first = c == s + 1;
        sums = first ? child : crossed(sums, child);
      } else {
        sums.insert(child.begin(), child.end());
      }
    }
    if (sums.empty()) sums = {{0, s}};
  }
  Sums other_regions(int parallel, int region) const {
    Sums sums = {{0, region}};
    for (int c = parallel + 1; c < state(parallel).end; c = state(c).end) {
      if (c == region || state(c).history >= 0) continue;
      sums = crossed(sums, with_weight(c, below(c)));
    }
    return sums;
  }
  int child_towards(int s, const std::vector<int>& targets) const {
    for (int t : targets) {
      if (!b_.is_descendant(t, s)) continue;
      while (state(t).parent != s) t = state(t).parent;
      return t;
    }
    return -1;
  }

  const Behavior& b_;
  std::vector<Sums> below_;
};

// States activated by a transition; deterministic below `domain`.
struct Arrival {
  int domain = 0;
  std::vector<int> active;  // strictly below the domain
};

class Succession {
 public:
  explicit Succession(const Behavior& behavior)
      : b_(behavior), walk_(behavior), done_states_(behavior.events.size(), -1) {
    for (std::size_t s = 0; s < b_.states.size(); ++s) {
      const int event = b_.states[s].done_event;
      if (event < 0) continue;
      done_states_[at(b_.event_ranks[at(event)])] = static_cast<int>(s);
    }
  }

  std::vector<ControlChange> all() {
    std::vector<ControlChange> changes;
    for (std::size_t t = 0; t < b_.transitions.size(); ++t) {
      const auto index = static_cast<int>(t);
      if (index != b_.safe_transition) add(index, changes);
    }
    return changes;
  }

 private:
  void add(int index, std::vector<ControlChange>& changes) const {
    const auto arrival = arrive(index);
    if (!arrival || ends_run(*arrival) || is_safe(*arrival)) return;
    const int top = arrival->domain;
    Sums inside;
    for (const int s : starts(index)) {
      const Sums sums = s == top ? walk_.below(top) : walk_.above(s, top, walk_.below(s));
      inside.insert(sums.begin(), sums.end());
    }
    const int arrived = walk_.weight(arrival->active);
    std::set<std::pair<int, int>> pairs;
    for (const auto& around : walk_.outside(top)) {
      for (const auto& before : inside) {
        const int from = around.first + before.first;
        const int to = around.first + arrived;
        if (from == to || pairs.size() >= kMaxPairs || !pairs.insert({from, to}).second) continue;
        changes.push_back({index, from, to, top, arrival->active});
      }
    }
  }

  // States, one of which is active when the transition is taken. If the transition waits for `done`
  // of a compound state, these are its final children; none if it has no condition, because they
  // were then passed through when entered.
  std::vector<int> starts(int index) const {
    const TransitionInfo& transition = b_.transitions[at(index)];
    std::vector<int> parents;
    const Range heard = b_.heard_events[at(index)];
    for (int k = heard.first; k < heard.end(); ++k) {
      const Range ranks = b_.heard_ranks[at(k)];
      for (int rank = ranks.first; rank < ranks.end(); ++rank) {
        const int done = done_states_[at(rank)];
        if (done < 0 || b_.states[at(done)].kind != StateKind::compound) return {transition.source};
        parents.push_back(done);
      }
    }
    std::sort(parents.begin(), parents.end());
    std::vector<int> finals;
    for (const int parent : parents) {
      for (int c = parent + 1; c < b_.states[at(parent)].end; c = b_.states[at(c)].end) {
        if (b_.states[at(c)].kind == StateKind::final) finals.push_back(c);
      }
    }
    if (finals.empty()) return {transition.source};
    return transition.guard < 0 && transition.after < 0 ? std::vector<int>{} : finals;
  }

  std::optional<Arrival> arrive(int index) const {
    const TransitionInfo& transition = b_.transitions[at(index)];
    if (transition.targets.count == 0 || transition.domain < 0) return std::nullopt;
    Arrival arrival;
    arrival.domain = transition.domain;
    walk_.enter_children(transition.domain, walk_.targets_of(transition.targets), arrival.active);
    for (int k = 0; k < kMaxPassed; ++k) {
      const int next = passed_by(arrival);
      if (next < 0) return arrival;
      if (!pass(b_.transitions[at(next)], arrival)) return std::nullopt;
    }
    return arrival;
  }

  // A transition that is always taken in the same tick, -1 if none.
  int passed_by(const Arrival& arrival) const {
    for (const int s : arrival.active) {
      if (b_.states[at(s)].kind != StateKind::atomic) continue;
      for (int p = s; p >= 0; p = b_.states[at(p)].parent) {
        if (const int t = find(p, -1); t >= 0) return t;
        if (p == arrival.domain) break;
      }
    }
    for (const int s : arrival.active) {
      const int parent = b_.states[at(s)].parent;
      if (b_.states[at(s)].kind != StateKind::final || parent < 0) continue;
      if (b_.states[at(parent)].done_event < 0) continue;
      for (int p = parent; p >= 0; p = b_.states[at(p)].parent) {
        if (const int t = find(p, b_.states[at(parent)].done_event); t >= 0) return t;
      }
    }
    return -1;
  }
  // The first unconditional transition of a state for this event (-1: event-less), -1 if none.
  int find(int s, int event) const {
    const Range& range = b_.states[at(s)].transitions;
    for (int t = range.first; t < range.end(); ++t) {
      const TransitionInfo& transition = b_.transitions[at(t)];
      if (transition.targets.count == 0 || transition.guard >= 0 || transition.after >= 0) continue;
      if (event < 0 ? !transition.has_event : transition.has_event && b_.matches(t, event)) {
        return t;
      }
    }
    return -1;
  }
  bool pass(const TransitionInfo& transition, Arrival& arrival) const {
    const int domain = transition.domain;
    if (domain < 0) return false;
    const std::vector<int> targets = walk_.targets_of(transition.targets);
    if (!b_.is_descendant(domain, arrival.domain)) {
      arrival.domain = domain;
      arrival.active.clear();
    } else {
      std::erase_if(arrival.active, [&](int s) { return b_.is_descendant(s, domain); });
    }
    walk_.enter_children(domain, targets, arrival.active);
    return true;
  }

  bool ends_run(const Arrival& arrival) const {
    return std::any_of(arrival.active.begin(), arrival.active.end(), [&](int s) {
      return b_.states[at(s)].kind == StateKind::final && b_.states[at(s)].parent == 0;
    });
  }
  bool is_safe(const Arrival& arrival) const {
    if (b_.safe_transition < 0) return false;
    const Range& range = b_.transitions[at(b_.safe_transition)].targets;
    return range.count > 0 && std::find(arrival.active.begin(), arrival.active.end(),
                                        b_.targets[at(range.first)]) != arrival.active.end();
  }

  const Behavior& b_;
  Walker walk_;
  std::vector<int> done_states_;  // by rank of the event: state of its done.state, -1: none
};

}  // namespace

std::map<int, int> controlling_states(const Behavior& behavior) {
  std::map<int, int> states;
  if (behavior.states.empty()) return states;
  const Walker walk(behavior);
  for (const auto& [control, leaf] : walk.with_weight(0, walk.below(0))) states[control] = leaf;
  for (const TransitionSpec& transition : behavior.contact_transitions) {
    if (transition.toward >= 0) states.emplace(transition.toward, transition.owner);
  }
  return states;
}

FirstControl first_control(const Behavior& behavior) {
  if (behavior.states.empty()) return {};
  const Walker walk(behavior);
  std::vector<int> active;
  walk.enter(0, {}, active);
  return {active.back(), walk.weight(active)};
}

std::vector<ControlChange> control_changes(const Behavior& behavior) {
  if (behavior.states.empty()) return {};
  return Succession(behavior).all();
}

}  // namespace footfall::behaviors
