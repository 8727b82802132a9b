// The table of faults; see fault_rules.h.
#include "model/robot/fault_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/value_reader.h"
#include "model/robot/keys.h"

namespace footfall::model {
namespace {

using core::Fault;
using core::Reaction;

constexpr std::string_view kEnds = "the run ends in any case";
constexpr std::string_view kNoNumber = "no torque can be computed";
constexpr std::string_view kBlind = "the state of the robot is unknown";

constexpr auto kRules = std::to_array<FaultRule>({
    {Fault::fall, "torso too low, tilted too far, or a body but a foot touches",
     Reaction::safe_state, kEnds},
    {Fault::non_finite, "a measured state or a torque is not a number", Reaction::safe_stop,
     kNoNumber},
    {Fault::torque_limit,
     "a torque asked for is at or beyond the joint's limit",
     Reaction::keep_going,
     {}},
    {Fault::torque_step,
     "a joint's torque changes by more than `limits.torque_step` in a tick",
     Reaction::keep_going,
     {}},
    {Fault::joint_limit, "a joint is beyond its position limits", Reaction::keep_going, {}},
    {Fault::swing_too_long,
     "a foot is in the air for longer than `limits.swing` while stepping",
     Reaction::safe_stop,
     {}},
    {Fault::simulator_warning, "the backend warned or reset itself", Reaction::safe_state, kEnds},
    {Fault::sensor_stale,
     "a read brings no new data, or the joints are frozen",
     Reaction::keep_going,
     {}},
    {Fault::imu_stale,
     "the IMU's data are older than `limits.imu_age`, or frozen",
     Reaction::keep_going,
     {}},
    {Fault::mocap_stale,
     "motion capture's data are older than `limits.mocap_age`, or frozen",
     Reaction::keep_going,
     {}},
    {Fault::tick_overrun, "`limits.overruns` ticks in a row begin late", Reaction::keep_going, {}},
    {Fault::planner_late, "a plan's deadline passes without an answer", Reaction::keep_going, {}},
    {Fault::execution, "an `error.execution` of the statechart", Reaction::keep_going, {}},
    {Fault::event_overflow,
     "an event or a script's request finds its queue full",
     Reaction::keep_going,
     {}},
    {Fault::rank_loss,
     "a task has less rank than in the nominal posture",
     Reaction::keep_going,
     {}},
    {Fault::no_estimate, "the estimator cannot give a state", Reaction::safe_stop, kBlind},
    {Fault::script_stuck, "a script does not come back from a call", Reaction::safe_stop, {}},
    {Fault::swing_contact,
     "a swing foot bears load for more than half of its phase",
     Reaction::keep_going,
     {}},
    {Fault::condition,
     "a task's level is worse conditioned than `limits.condition`",
     Reaction::keep_going,
     {}},
    {Fault::load_air,
     "a foot that swung is loaded without ground contact",
     Reaction::keep_going,
     {}},
    {Fault::sensor_clock,
     "the sensors' clock jumps by more than 10 ticks, goes back, or stands still",
     Reaction::keep_going,
     {}},
    {Fault::sensor_nan,
     "a measured value that the estimator uses is not a number",
     Reaction::safe_state,
     {}},
    {Fault::slip,
     "a foot slides along the ground by more than `limits.slip`",
     Reaction::keep_going,
     {}},
});

constexpr bool in_order() {
  for (std::size_t f = 0; f < kRules.size(); ++f) {
    if (static_cast<std::size_t>(kRules[f].fault) != f) return false;
  }
  return true;
}
static_assert(kRules.size() == std::size_t{core::kFaultCount} && in_order());

void set_reaction(const core::YamlEntry& entry, Fault fault, Reaction reaction,
                  RobotDescription& robot, core::Diagnostics& diagnostics) {
  const auto index = static_cast<std::size_t>(fault);
  const std::string_view refusing = kRules[index].refusing;
  const std::string never = why_never(robot, fault);
  if (!never.empty()) {
    diagnostics.error(entry.key_mark, "impossible-fault",
                      fmt::format("this robot never has '{}': {}", entry.key, never));
  } else if (reaction == Reaction::keep_going && !refusing.empty()) {
    diagnostics.error(entry.value.mark, "refused-reaction",
                      fmt::format("'{}' cannot continue: {}; it is safe_state or safe_stop",
                                  entry.key, refusing));
  } else {
    robot.reactions[index] = reaction;
  }
}

std::string hint_or_list(std::string_view word, const std::vector<std::string>& names) {
  const std::string hint = core::did_you_mean(word, names);
  return hint.empty() ? fmt::format(", there are {}", fmt::join(names, ", ")) : hint;
}

}  // namespace

std::span<const FaultRule> fault_rules() { return kRules; }

std::string why_never(const RobotDescription& robot, Fault fault) {
  switch (fault) {
    case Fault::imu_stale:
      return robot.sensors.imu_site.empty() ? "it has no `sensors: {imu: ...}`" : "";
    case Fault::mocap_stale:
      return robot.sensors.mocap_sites.empty() ? "it has no `sensors: {mocap: ...}`" : "";
    case Fault::torque_step:
      return robot.torque_step_limit > 0.0 ? "" : "it has no `limits: {torque_step: ...}`";
    case Fault::swing_too_long:
    case Fault::swing_contact:
    case Fault::load_air:
    case Fault::slip:
      return robot.contacts.empty() ? "it has no `contacts`" : "";
    default:
      return {};
  }
}

void read_reactions(const core::YamlNode& node, RobotDescription& robot,
                    core::Diagnostics& diagnostics) {
  if (!core::expect_map(node, "a map of reactions by fault", diagnostics)) return;
  std::vector<std::string> names;
  for (const FaultRule& rule : kRules) names.emplace_back(core::fault_name(rule.fault));
  for (const core::YamlEntry& entry : node.entries) {
    const auto found = std::find(names.begin(), names.end(), entry.key);
    const auto choice = core::read_choice(entry.value, kReactions, diagnostics, "a reaction");
    if (found == names.end()) {
      diagnostics.error(entry.key_mark, "unknown-fault",
                        fmt::format("no fault '{}'{}", entry.key, hint_or_list(entry.key, names)));
    } else if (choice) {
      set_reaction(entry, static_cast<Fault>(found - names.begin()), static_cast<Reaction>(*choice),
                   robot, diagnostics);
    }
  }
}

}  // namespace footfall::model
