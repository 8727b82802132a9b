// Loops taken within one tick again and again, until `micro_steps` ends them: cycles of event-less
// transitions without time and without change of a condition.
//
// A cycle without conditions is certain. Otherwise one condition, an expression of signals and
// parameters, is assumed to be true, or false, throughout the tick, and every further one that
// stands before a transition of the cycle to be false. Nothing is reported if these assumptions
// could contradict each other, which conditions without common operands cannot.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "behaviors/check/structure/structure.h"
#include "behaviors/load/substitution.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

constexpr std::size_t kMaxConditions = 500;  // beyond, no check (too slow)

// What a transition waits for, unless it is one of the conditions, which count from 0.
constexpr int kNever = -1, kAlways = -2, kUnknown = -3;

// Assumption for a tick: index of the condition, -1 for none, and its value.
struct Assumption {
  int condition = -1;
  bool holds = false;
};

class LoopCheck {
 public:
  LoopCheck(LoadContext& context, const Reach& reach)
      : context_(context), chart_(context.behavior), reach_(reach), entry_(chart_) {}

  void report() {
    look_at_transitions();
    follow_all({});
    for (int condition = 0; condition < static_cast<int>(conditions_.size()); ++condition) {
      follow_all({condition, true});
      follow_all({condition, false});
    }
    for (int t = 0; t < static_cast<int>(chart_.transitions.size()); ++t) check_staying(t);
    for (const auto& finding : findings_.found()) {
      context_.warning(finding.mark, "possible-loop", finding.text);
    }
  }

 private:
  struct Step {
    int transition = -1;
    int leaf = -1;  // -1: no step, or none that is certain
  };

  const StateInfo& state(int s) const { return chart_.states[at(s)]; }
  const TransitionInfo& transition(int t) const { return chart_.transitions[at(t)]; }
  int guard_of(Assumption given) const {
    return given.condition < 0 ? -1 : transition(conditions_[at(given.condition)]).guard;
  }

  // Computes once what each transition waits for: its `after` in ticks (-1: unknown), and the
  // condition, if only a new tick or a `set` can change it.
  void look_at_transitions() {
    const int count = static_cast<int>(chart_.transitions.size());
    for (int t = 0; t < count; ++t) {
      const TransitionInfo& info = transition(t);
      waits_.push_back(info.after < 0 ? 0 : planned_ticks(context_, info.after).value_or(-1));
      conditions_of_.push_back(condition_of(t));
    }
  }

  int condition_of(int t) {
    const TransitionInfo& info = transition(t);
    if (info.has_event || never_true(context_, t)) return kNever;
    if (always_true(context_, t)) return kAlways;
    if (reads(info.guard, Op::state_time) || reads(info.guard, Op::in_state)) {
      return kUnknown;
    }
    const auto same = [&](int other) {
      return same_expression(chart_, transition(other).guard, info.guard);
    };
    const auto found = std::find_if(conditions_.begin(), conditions_.end(), same);
    if (found == conditions_.end() && conditions_.size() == kMaxConditions) return kUnknown;
    if (found != conditions_.end()) return static_cast<int>(found - conditions_.begin());
    conditions_.push_back(t);
    return static_cast<int>(conditions_.size()) - 1;
  }

  bool reads(int guard, Op op, int index = -1) const {
    const Expression& e = chart_.expressions[guard];
    for (int k = e.first; k < e.first + e.count; ++k) {
      const Instruction& i = chart_.expressions.code[at(k)];
      if (i.op == op && (index < 0 || i.index == index)) return true;
    }
    return false;
  }

  // Whether the actions may change an input of the condition.
  bool changes(Range actions, int guard) const {
    for (int a = actions.first; a < actions.end() && guard >= 0; ++a) {
      const ActionInfo& action = chart_.actions[at(a)];
      if (action.kind == ActionKind::set && reads(guard, Op::parameter, action.index)) return true;
    }
    return false;
  }

  // Whether both can have any value independently: they read no common operand.
  bool independent(int a, int b) const {
    if (a < 0 || b < 0) return true;
    const ExpressionPool& pool = chart_.expressions;
    const Expression& e = pool[transition(conditions_[at(a)]).guard];
    for (int k = e.first; k < e.first + e.count; ++k) {
      const Instruction& i = pool.code[at(k)];
      const bool operand = i.op == Op::parameter || i.op == Op::signal || i.op == Op::time;
      if (operand && reads(transition(conditions_[at(b)]).guard, i.op, i.index)) return false;
    }
    return true;
  }

  // The value of a guard in the tick that enters its state, whatever the signals and variables are:
  // not a number is what is unknown. nullopt: uncertain.
  std::optional<bool> at_entry(int t, int leaf) const {
    const int guard = transition(t).guard;
    if (transition(t).source != leaf || reads(guard, Op::in_state) || reads(guard, Op::time)) {
      return std::nullopt;
    }
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> values = context_.behavior.values;
    for (const ParameterInfo& info : context_.behavior.parameters) {
      if (info.variable) std::fill_n(values.begin() + info.slot, info.size, unknown);
    }
    const std::vector<double> signals(at(context_.behavior.signals.size()), unknown);
    const std::vector<std::int64_t> entered(chart_.states.size(), 0);
    EvaluationContext now;
    now.parameters = values.data();
    now.signals = signals.data();
    now.entry_ticks = entered.data();
    const double value = evaluate(chart_.expressions, guard, now);
    return std::isfinite(value) ? std::optional(value != 0.0) : std::nullopt;
  }

  // The event-less transition taken from a leaf without delay, if the conditions before it that are
  // neither known nor given are false (`denied`); -1: none, or uncertain.
  int next_transition(int leaf, Assumption given, std::vector<int>* denied = nullptr) const {
    for (int s = leaf; s >= 0; s = state(s).parent) {
      const Range own = state(s).transitions;
      for (int t = own.first; t < own.end(); ++t) {
        const int condition = conditions_of_[at(t)];
        if (condition == kNever || waits_[at(t)] > 0) continue;
        if (waits_[at(t)] < 0) return -1;
        if (condition == kAlways) return t;
        if (condition == kUnknown) {
          const auto known = at_entry(t, leaf);
          if (!known) return -1;
          if (*known) return t;
        } else if (condition == given.condition) {
          if (given.holds) return t;
        } else if (independent(condition, given.condition)) {
          if (denied != nullptr) denied->push_back(condition);
        } else {
          return -1;
        }
      }
    }
    return -1;
  }

  Step next(int leaf, Assumption given) {
    Step step{next_transition(leaf, given), -1};
    if (step.transition < 0) return step;
    const TransitionInfo& taken = transition(step.transition);
    if (taken.targets.count == 0 || taken.domain < 0) return step;
    int found = -1;
    for (const int s : entry_.of(taken)) {
      if (state(s).kind == StateKind::parallel || state(s).kind == StateKind::final) return step;
      if (state(s).kind == StateKind::atomic) found = s;
    }
    if (!changes_on_the_way(leaf, taken, guard_of(given))) step.leaf = found;
    return step;
  }

  // Whether the actions of a transition, or of what it exits and enters, may change the condition.
  bool changes_on_the_way(int leaf, const TransitionInfo& taken, int guard) {
    bool changed = changes(taken.actions, guard);
    for (int s = leaf; s > taken.domain; s = state(s).parent) {
      changed = changed || changes(state(s).on_exit, guard);
    }
    for (const int s : entry_.of(taken)) changed = changed || changes(state(s).on_entry, guard);
    return changed;
  }

  // The conditions that must be false for a cycle, each once; nullopt if they may contradict each
  // other or change on the way.
  std::optional<std::vector<int>> denied_in(int start, Assumption given) {
    std::vector<int> denied;
    int leaf = start;
    do {
      leaf = next(leaf, given).leaf;
      next_transition(leaf, given, &denied);
    } while (leaf != start);
    std::ranges::sort(denied);
    const auto repeated = std::ranges::unique(denied);
    denied.erase(repeated.begin(), repeated.end());
    for (std::size_t a = 0; a < denied.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (!independent(denied[a], denied[b])) return std::nullopt;
      }
      do {
        const Step step = next(leaf, given);
        const int guard = transition(conditions_[at(denied[a])]).guard;
        if (changes_on_the_way(leaf, transition(step.transition), guard)) return std::nullopt;
        leaf = step.leaf;
      } while (leaf != start);
    }
    return denied;
  }

  void follow_all(Assumption given) {
    std::vector<int> seen(chart_.states.size(), -1);  // by leaf: start of the path that visited it
    for (int leaf = 0; leaf < static_cast<int>(chart_.states.size()); ++leaf) {
      if (state(leaf).kind != StateKind::atomic || reach_.with_safe[at(leaf)] == 0) continue;
      int now = leaf;
      while (now >= 0 && seen[at(now)] < 0) {
        seen[at(now)] = leaf;
        now = next(now, given).leaf;
      }
      if (now >= 0 && seen[at(now)] == leaf) report_cycle(now, given);
    }
  }

  void report_cycle(int start, Assumption given) {
    const auto denied = denied_in(start, given);
    if (!denied) return;
    std::string names = fmt::format("'{}'", state(start).path);
    bool in_region = false;
    int first = -1, leaf = start;
    do {
      const Step step = next(leaf, given);
      if (first < 0 || step.transition < first) first = step.transition;
      for (int s = leaf; s >= 0; s = state(s).parent) {
        in_region = in_region || state(s).kind == StateKind::parallel;
      }
      leaf = step.leaf;
      names += fmt::format(" -> '{}'", state(leaf).path);
    } while (leaf != start);
    if (!reported_.insert(first).second) return;
    // A pure statechart is only traced: there the loop is bounded, and no robot moves.
    say(first, given.condition < 0 && denied->empty() && !in_region && context_.behavior.has_robot,
        fmt::format("{} is a loop that takes no time{}: it needs an `after` or a condition that "
                    "ends it",
                    names, assumed_text(given, *denied)));
  }

  std::string condition_text(int condition) const {
    const int t = conditions_[at(condition)];
    const core::YamlNode& when = *transition_keys(context_, t).find("when");
    return "'" + read_marked(when.scalar).text + "'";
  }

  // while 'A' and not 'B' / unless 'A' or 'B'
  std::string assumed_text(Assumption given, const std::vector<int>& denied) const {
    std::string text;
    if (given.condition >= 0) {
      text = (given.holds ? " while " : " unless ") + condition_text(given.condition);
    }
    const bool holds = given.condition >= 0 && given.holds;
    for (const int condition : denied) {
      text += text.empty() ? " unless " : holds ? " and not " : " or ";
      text += condition_text(condition);
    }
    return text;
  }

  // Actions without `to`: the state is not exited, so the condition does not change.
  void check_staying(int t) {
    const TransitionInfo& info = transition(t);
    if (info.has_event || info.after >= 0 || info.targets.count > 0) return;
    if (conditions_of_[at(t)] == kNever) return;
    if (reach_.with_safe[at(info.source)] == 0 || changes(info.actions, info.guard)) return;
    if (info.guard >= 0 && reads(info.guard, Op::in_state)) return;
    say(t, conditions_of_[at(t)] == kAlways && context_.behavior.has_robot,
        "this is taken again and again in the same tick as long as `when` holds: take an event "
        "(`on:`), or `after: 0 s`, which is taken once an entry");
  }

  void say(int t, bool certain, std::string text) {
    const core::Mark mark = transition(t).mark;
    if (certain) {
      context_.error(mark, "zero-time-loop", std::move(text));
    } else {
      findings_.look(mark, true, std::move(text));
    }
  }

  LoadContext& context_;
  const Chart& chart_;
  const Reach& reach_;
  EntrySet entry_;
  std::vector<std::int64_t> waits_;  // by transition
  std::vector<int> conditions_of_;   // by transition
  std::vector<int> conditions_;      // a transition with that condition
  std::set<int> reported_;           // by first transition
  Findings findings_;
};

}  // namespace

void check_loops(LoadContext& context, const Reach& reach) { LoopCheck(context, reach).report(); }

}  // namespace footfall::behaviors
