// Correspondence between two behaviors for bumpless transfer; see take_over_map.h.
#include "behaviors/compiled/take_over_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "core/diagnostics/did_you_mean.h"
#include "core/index.h"
#include "core/same_bits.h"

namespace footfall::behaviors {
namespace {

int find(const std::unordered_map<std::string, int>& by_name, const std::string& name) {
  const auto found = by_name.find(name);
  return found == by_name.end() ? -1 : found->second;
}

bool is_state_of_old(const std::vector<int>& map, int state) {
  return std::ranges::find(map, state) != map.end();
}

// Whether every region of the new parallel state continues one of the old.
bool same_regions(const Chart& to, int state, const std::vector<int>& map) {
  for (int c = state + 1; c < to.states[at(state)].end; c = to.states[at(c)].end) {
    if (to.states[at(c)].history < 0 && !is_state_of_old(map, c)) return false;
  }
  return true;
}

std::vector<int> map_states(const Behavior& from, const Behavior& to) {
  std::unordered_map<std::string, int> by_path;
  for (std::size_t s = 1; s < to.states.size(); ++s)
    by_path[to.states[s].path] = static_cast<int>(s);
  std::vector<int> map;
  for (std::size_t s = 0; s < from.states.size(); ++s) {
    const StateInfo& old = from.states[s];
    const int here = s == 0 ? 0 : find(by_path, old.path);
    map.push_back(here >= 0 && to.states[at(here)].kind == old.kind ? here : -1);
  }
  for (int& here : map) {
    const bool parallel = here >= 0 && to.states[at(here)].kind == StateKind::parallel;
    if (parallel && !same_regions(to, here, map)) here = -1;
  }
  return map;
}

std::vector<int> map_names(const std::vector<std::string>& from,
                           const std::vector<std::string>& to) {
  std::unordered_map<std::string, int> by_name;
  for (std::size_t k = 0; k < to.size(); ++k) by_name.emplace(to[k], static_cast<int>(k));
  std::vector<int> map;
  for (const std::string& name : from) map.push_back(find(by_name, name));
  return map;
}

std::vector<int> map_signals(const Behavior& from, const Behavior& to) {
  std::vector<int> map;
  for (int s = 0; s < from.signals.size(); ++s) {
    const core::SignalInfo& old = from.signals.info(s);
    const int here = to.signals.find(old.name);
    const bool same = here >= 0 && to.signals.info(here).dimension == old.dimension;
    map.push_back(same ? here : -1);
  }
  return map;
}

// A single old value initialises all values of a vector.
std::vector<int> map_slots(const Behavior& from, const Behavior& to) {
  std::vector<int> map(to.values.size(), -1);
  std::unordered_map<std::string, int> by_name;
  for (std::size_t p = 0; p < from.parameters.size(); ++p) {
    by_name.emplace(from.parameters[p].name, static_cast<int>(p));
  }
  for (const ParameterInfo& info : to.parameters) {
    const int p = find(by_name, info.name);
    if (p < 0) continue;
    const ParameterInfo& old = from.parameters[at(p)];
    if (old.dimension != info.dimension || (old.size != info.size && old.size != 1)) continue;
    for (int k = 0; k < info.size; ++k) {
      map[at(info.slot + k)] = old.slot + (old.size == 1 ? 0 : k);
    }
  }
  return map;
}

// Whether two compiled expressions compute the same value from the same inputs.
bool same_expression(const Behavior& from, int a, const Behavior& to, int b,
                     const TakeOverMap& map) {
  const Expression& old = from.expressions[a];
  const Expression& now = to.expressions[b];
  if (old.count != now.count) return false;
  for (int k = 0; k < old.count; ++k) {
    const Instruction& x = from.expressions.code[at(old.first + k)];
    const Instruction& y = to.expressions.code[at(now.first + k)];
    if (x.op != y.op) return false;
    bool same = x.index == y.index;
    if (x.op == Op::constant) {
      same = core::same_bits(x.value, y.value);
    } else if (x.op == Op::parameter) {
      same = map.slots[at(y.index)] == x.index;
    } else if (x.op == Op::signal) {
      same = map.signals[at(x.index)] == y.index;
    } else if (x.op == Op::state_time || x.op == Op::in_state) {
      same = map.states[at(x.index)] == y.index;
    }
    if (!same) return false;
  }
  return true;
}

void map_transitions(const Behavior& from, const Behavior& to, TakeOverMap& map) {
  map.transitions.assign(from.transitions.size(), -1);
  map.same_after.assign(from.transitions.size(), 0);
  for (std::size_t s = 0; s < from.states.size(); ++s) {
    if (map.states[s] < 0) continue;
    const Range mine = from.states[s].transitions;
    const Range theirs = to.states[at(map.states[s])].transitions;
    for (int k = 0; k < std::min(mine.count, theirs.count); ++k) {
      const TransitionInfo& old = from.transitions[at(mine.first + k)];
      const TransitionInfo& now = to.transitions[at(theirs.first + k)];
      if (old.has_event != now.has_event || (old.after < 0) != (now.after < 0)) continue;
      map.transitions[at(mine.first + k)] = theirs.first + k;
      map.same_after[at(mine.first + k)] =
          old.after >= 0 && same_expression(from, old.after, to, now.after, map) ? 1 : 0;
    }
  }
}

void map_invokes(const Behavior& from, const Behavior& to, TakeOverMap& map) {
  map.invokes.assign(from.invokes.size(), -1);
  for (std::size_t s = 0; s < from.states.size(); ++s) {
    if (map.states[s] < 0) continue;
    const Range mine = from.states[s].invokes;
    const Range theirs = to.states[at(map.states[s])].invokes;
    for (int k = 0; k < std::min(mine.count, theirs.count); ++k) {
      const int planner = map.planners[at(from.invokes[at(mine.first + k)].planner)];
      const bool same = planner >= 0 && planner == to.invokes[at(theirs.first + k)].planner;
      if (same) map.invokes[at(mine.first + k)] = theirs.first + k;
    }
  }
}

void map_instances(const Behavior& from, const Behavior& to, TakeOverMap& map) {
  for (const TaskInstance& old : from.task_instances) {
    const auto found = std::ranges::find_if(to.task_instances, [&](const TaskInstance& task) {
      return task.name == old.name && task.type == old.type && task.point == old.point;
    });
    map.instances.push_back(found == to.task_instances.end()
                                ? -1
                                : static_cast<int>(found - to.task_instances.begin()));
  }
}

void map_histories(const Behavior& from, const Behavior& to, TakeOverMap& map) {
  map.histories.assign(at(from.history_count), -1);
  for (std::size_t s = 0; s < from.states.size(); ++s) {
    if (from.states[s].history < 0 || map.states[s] < 0) continue;
    map.histories[at(from.states[s].history)] = to.states[at(map.states[s])].history;
  }
}

bool weigh_alike(const Behavior& from, const Behavior& to, const TakeOverMap& map) {
  if (from.states.size() != to.states.size() || from.controls.size() != to.controls.size()) {
    return false;
  }
  for (std::size_t s = 0; s < from.states.size(); ++s) {
    const int here = map.states[s];
    if (here < 0 || from.states[s].control_weight != to.states[at(here)].control_weight) {
      return false;
    }
  }
  return true;
}

std::vector<std::string> planner_names(const Behavior& behavior) {
  std::vector<std::string> names;
  for (const PlannerInfo& planner : behavior.planners) names.push_back(planner.name);
  return names;
}

bool is_atomic(const StateInfo& state) {
  return state.kind == StateKind::atomic || state.kind == StateKind::final;
}

bool same_joints(const model::RobotDescription& a, const model::RobotDescription& b) {
  return std::ranges::equal(a.joints, b.joints, [](const auto& x, const auto& y) {
    return x.name == y.name && x.position_min == y.position_min &&
           x.position_max == y.position_max && x.torque_limit == y.torque_limit;
  });
}

bool same_places(const model::RobotDescription& a, const model::RobotDescription& b) {
  return std::ranges::equal(a.contacts, b.contacts,
                            [](const auto& x, const auto& y) {
                              return x.name == y.name && x.site == y.site && x.type == y.type &&
                                     x.radius == y.radius;
                            }) &&
         std::ranges::equal(a.points, b.points, [](const auto& x, const auto& y) {
           return x.name == y.name && x.site == y.site && x.body == y.body;
         });
}

void compare_robots(const model::RobotDescription& a, const model::RobotDescription& b,
                    std::vector<std::string>& reasons) {
  const auto differ = [&](const char* what) {
    reasons.push_back(
        fmt::format("the robot has other {} in '{}': a reload changes the behavior "
                    "alone, start anew for this",
                    what, b.path));
  };
  if (a.rate_mhz != b.rate_mhz) differ("periods (`rate`)");
  if (!same_joints(a, b)) differ("joints");
  if (!same_places(a, b)) differ("contacts or points");
  if (a.model_path != b.model_path) differ("bodies (`model`)");
  if (a.reactions != b.reactions || a.tilt_limit != b.tilt_limit ||
      a.height_limit != b.height_limit || a.torque_step_limit != b.torque_step_limit ||
      a.standing_height != b.standing_height || a.overruns != b.overruns ||
      a.swing_limit != b.swing_limit || a.condition_limit != b.condition_limit) {
    differ("limits or reactions to faults");
  }
}

}  // namespace

TakeOverMap map_take_over(const Behavior& from, const Behavior& to) {
  TakeOverMap map;
  map.states = map_states(from, to);
  map.events = map_names(from.events, to.events);
  map.planners = map_names(planner_names(from), planner_names(to));
  map.signals = map_signals(from, to);
  map.slots = map_slots(from, to);
  map_transitions(from, to, map);
  map_invokes(from, to, map);
  map_instances(from, to, map);
  map.internals = map_names(from.internal_instances, to.internal_instances);
  map_histories(from, to, map);
  map.same_controls = weigh_alike(from, to, map);
  return map;
}

bool permits_reload(const Chart& chart, int state) {
  for (int s = state; s >= 0; s = chart.states[at(s)].parent) {
    if (chart.states[at(s)].reload) return true;
  }
  return false;
}

std::vector<std::string> reasons_against_take_over(const Behavior& from, const Behavior& to,
                                                   const TakeOverMap& map) {
  std::vector<std::string> reasons;
  if (!to.has_robot) return {"the file has no `robot:` any more"};
  compare_robots(from.robot, to.robot, reasons);
  std::vector<std::string> permitting, paths;
  bool some_stays = false;
  for (std::size_t s = 0; s < from.states.size(); ++s) {
    if (!is_atomic(from.states[s]) || !permits_reload(from, static_cast<int>(s))) continue;
    permitting.push_back("'" + from.states[s].path + "'");
    some_stays |= map.states[s] >= 0;
  }
  if (permitting.empty()) {
    reasons.push_back(
        "no state of the behavior that runs says `reload: ok`, so there is no moment to do it");
  } else if (!some_stays) {
    for (const StateInfo& state : to.states) {
      if (is_atomic(state)) paths.push_back(state.path);
    }
    const std::string first = permitting.front().substr(1, permitting.front().size() - 2);
    reasons.push_back(
        fmt::format("the states in which it may be done are not in the file any more: "
                    "{}{}",
                    fmt::join(permitting, ", "), core::did_you_mean(first, paths)));
  }
  return reasons;
}

}  // namespace footfall::behaviors
