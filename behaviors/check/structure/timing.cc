// Unsuitable times: shorter than the robot can resolve, or longer than their state. Parameters have
// the values of the file (or of --set).
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/check/structure/structure.h"
#include "behaviors/compiled/static_values.h"
#include "behaviors/compiled/times.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

constexpr std::int64_t kShortestPhase = 2;  // ticks

class TimingCheck {
 public:
  explicit TimingCheck(LoadContext& context) : context_(context), behavior_(context.behavior) {}

  void report() {
    for (std::size_t t = 0; t < behavior_.transitions.size(); ++t) check_phase(static_cast<int>(t));
    for (const TransitionSpec& spec : behavior_.contact_transitions) check_ramp(spec);
    for (const TaskSpec& task : behavior_.tasks) check_trajectory(task.reference);
    for (const InvokeInfo& invoke : behavior_.invokes) check_invoke(invoke);
    for (const auto& finding : too_short_.found()) {
      context_.warning(finding.mark, "too-short", finding.text);
    }
    for (const auto& finding : cut_off_.found()) {
      context_.warning(finding.mark, "cut-off", finding.text);
    }
    for (const auto& finding : never_asked_.found()) {
      context_.warning(finding.mark, "never-asked", finding.text);
    }
  }

 private:
  double rate() const { return static_cast<double>(behavior_.rate_mhz) / 1e3; }

  // Maximum duration of a state, from its own transitions, in ticks.
  std::optional<std::int64_t> duration(int state) const {
    const Range own = behavior_.states[at(state)].transitions;
    std::optional<std::int64_t> shortest;
    for (int t = own.first; t < own.end(); ++t) {
      const TransitionInfo& transition = behavior_.transitions[at(t)];
      if (transition.after < 0 || transition.has_event || transition.targets.count == 0) continue;
      if (!always_true(context_, t)) continue;
      const auto ticks = planned_ticks(context_, transition.after);
      if (ticks && (!shortest || *ticks < *shortest)) shortest = ticks;
    }
    return shortest;
  }

  void look_short(core::Mark mark, const char* what, std::optional<std::int64_t> ticks) {
    too_short_.look(mark, ticks && *ticks < kShortestPhase,
                    ticks ? fmt::format("{} lasts {} tick{} at {} Hz: at least {} are needed", what,
                                        *ticks, *ticks == 1 ? "" : "s", rate(), kShortestPhase)
                          : "");
  }

  // Checks a state with a fixed duration; with a condition, or with 0 s and without control of its
  // own, the time is not a phase.
  void check_phase(int t) {
    const TransitionInfo& transition = behavior_.transitions[at(t)];
    if (transition.after < 0 || transition.has_event || transition.targets.count == 0) return;
    if (!always_true(context_, t)) return;
    const core::YamlNode& keys = context_.sources[at(transition.source)]->keys;
    const auto controls = [&](const char* key) { return keys.find(key) != nullptr; };
    const bool passes = !controls("tasks") && !controls("stack") && !controls("contacts") &&
                        !controls("contact_transition") && !controls("invoke");
    const auto ticks = planned_ticks(context_, transition.after);
    if (ticks == 0 && passes) return;
    look_short(transition_keys(context_, t).find("after")->mark, "this phase", ticks);
  }

  void look_cut_off(core::Mark mark, int state, int over, const char* what) {
    const auto ticks = planned_ticks(context_, over), end = duration(state);
    cut_off_.look(mark, ticks && end && *ticks > *end,
                  ticks && end ? fmt::format("{} takes {} ticks, but '{}' ends after {}", what,
                                             *ticks, behavior_.states[at(state)].path, *end)
                               : "");
  }

  void check_ramp(const TransitionSpec& spec) {
    const core::YamlNode* node = context_.sources[at(spec.owner)]->keys.find("contact_transition");
    const core::YamlNode* over = node == nullptr ? nullptr : node->find("over");
    if (over == nullptr) return;
    look_short(over->mark, "this contact transition", planned_ticks(context_, spec.over));
    look_cut_off(over->mark, spec.owner, spec.over, "this contact transition");
  }

  // A retargeted trajectory may be continued by the next state.
  void check_trajectory(const ReferenceSpec& reference) {
    if (reference.over < 0) return;
    look_short(reference.over_mark, "this trajectory", planned_ticks(context_, reference.over));
    if (reference.retarget > 0.0) return;
    look_cut_off(reference.over_mark, reference.owner, reference.over, "this trajectory");
  }

  void check_invoke(const InvokeInfo& invoke) {
    const auto end = duration(invoke.state);
    std::optional<std::int64_t> start = planned_ticks(context_, invoke.at);
    if (invoke.after >= 0) {
      const auto whole = planned_value(context_, invoke.after);
      const std::int64_t ticks =
          whole ? periods_of(invoke.at_fraction * *whole, behavior_.rate_mhz) : -1;
      start = ticks < 0 ? std::nullopt : std::optional(ticks);
    }
    never_asked_.look(
        invoke.at_mark, start && end && *start >= *end,
        start && end ? fmt::format("the planner is never asked: that is after {} ticks, and '{}' "
                                   "ends after {}",
                                   *start, behavior_.states[at(invoke.state)].path, *end)
                     : "");
  }

  LoadContext& context_;
  const Behavior& behavior_;
  Findings too_short_, cut_off_, never_asked_;
};

}  // namespace

void check_times(LoadContext& context) {
  const core::YamlNode* parameters = context.section("parameters");
  for (const BadTime& time : bad_times(context.behavior)) {
    std::string from;
    for (const int index : dependence_of(context.behavior, time.use->expression).parameters) {
      const std::string& name = context.behavior.parameters[at(index)].name;
      const core::YamlNode* node = parameters == nullptr ? nullptr : parameters->find(name);
      if (node == nullptr) continue;
      const core::YamlNode* value = node->find("value");
      const std::string place = place_of(context, (value == nullptr ? node : value)->mark);
      // A value of the command is written beside the message.
      from += fmt::format("{}'{}'{}", from.empty() ? " (from " : " and ", name,
                          place.starts_with("--") ? "" : " at " + place);
    }
    const std::string text =
        fmt::format("this time {}{}", bad_time_text(time), from + (from.empty() ? "" : ")"));
    // Without a robot nobody falls, and error.execution may be what the chart is about.
    if (context.behavior.has_robot) {
      context.error(time.use->mark, "out-of-range", text);
    } else {
      context.warning(time.use->mark, "no-time",
                      text + "; it never comes, and raises error.execution");
    }
  }
}

void check_timing(LoadContext& context) {
  if (context.behavior.has_robot) TimingCheck(context).report();
}

}  // namespace footfall::behaviors
