// `script` of a scenario: external events and their times.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/diagnostics/did_you_mean.h"
#include "engine/edits/door.h"
#include "lab/scenario/context.h"
#include "lab/scenario/keys.h"
#include "lab/scenario/loader.h"

namespace footfall::lab {
namespace {

using behaviors::Behavior;
using behaviors::ParameterInfo;
using core::YamlNode;

// A name such as `lift` selects the states of this name on the left and on the right.
std::vector<int> states_named(ScenarioContext& context, const YamlNode& node) {
  if (!core::expect_scalar(node, "the name of a state", context.diagnostics)) return {};
  if (context.names == nullptr) return {};
  const auto& states = context.scenario.behavior->states;
  std::vector<int> found;
  for (std::size_t s = 1; s < states.size(); ++s) {
    const std::string& path = states[s].path;
    if (path == node.scalar || path.ends_with("." + node.scalar)) {
      found.push_back(static_cast<int>(s));
    }
  }
  if (found.empty()) context.names->require_target(0, node);
  return found;
}

void read_place(ScenarioContext& context, const YamlNode& node, Moment& moment) {
  moment.kind = Moment::Kind::place;
  core::check_keys(node, kMomentKeys, context.diagnostics);
  const YamlNode* step = node.find("step");
  const YamlNode* state = node.find("state");
  if (step == nullptr && state == nullptr) expect_one_of(context, node, {"step", "state"});
  if (step != nullptr) {
    moment.step = core::read_integer(*step, 1, 1'000'000'000, context.diagnostics).value_or(0);
  }
  if (state != nullptr) moment.states = states_named(context, *state);
  const YamlNode* phase = node.find("phase");
  if (phase == nullptr) return;
  moment.phase = core::read_bounded(*phase, core::kNone, 0.0, 1.0, context.diagnostics, "a part")
                     .value_or(0.0);
  if (moment.phase >= 1.0) {
    context.error(phase->mark, "out-of-range", "expected a phase below 100 %");
  }
}

void report_unknown_event(ScenarioContext& context, const YamlNode& node, const char* advice) {
  const std::string near = core::did_you_mean(node.scalar, context.scenario.behavior->events);
  context.error(
      node.mark, "unknown-event",
      fmt::format("the behavior has no event '{}'{}", node.scalar, near.empty() ? advice : near));
}

// A name, or a prefix such as `fault.*`.
void read_event_moment(ScenarioContext& context, const YamlNode& node, Moment& moment) {
  moment.kind = Moment::Kind::event;
  if (!core::expect_scalar(node, "the name of an event", context.diagnostics)) return;
  moment.event = node.scalar;
  if (context.names == nullptr) return;
  const auto fits = [&node](const std::string& event) {
    return behaviors::Chart::event_matches(node.scalar, event);
  };
  if (std::ranges::none_of(context.scenario.behavior->events, fits)) {
    report_unknown_event(context, node, "");
  }
}

void read_moment(ScenarioContext& context, const YamlNode& node, Moment& moment) {
  if (!expect_one_of(context, node, {"at", "on"})) return;
  const YamlNode* at = node.find("at");
  if (at == nullptr) {
    read_event_moment(context, *node.find("on"), moment);
  } else if (at->is_map()) {
    read_place(context, *at, moment);
  } else {
    moment.time = read_time_in_run(context, *at).value_or(0.0);
  }
}

int read_raise(ScenarioContext& context, const YamlNode& node) {
  if (!core::expect_scalar(node, "the name of an event", context.diagnostics)) return -1;
  if (context.names == nullptr) return -1;
  const int event = context.scenario.behavior->find_event(node.scalar);
  if (event < 0) {
    report_unknown_event(context, node, ": list it in its `events`");
  } else if (engine::is_built_in_event(*context.scenario.behavior, event)) {
    context.error(node.mark, "built-in-event",
                  fmt::format("'{}' is raised by the engine only", node.scalar));
  }
  return event;
}

std::string read_body(ScenarioContext& context, const YamlNode& node) {
  if (!core::expect_scalar(node, "the name of a body", context.diagnostics)) return {};
  if (context.bodies && std::ranges::find(*context.bodies, node.scalar) == context.bodies->end()) {
    context.error(node.mark, "unknown-name",
                  fmt::format("the robot has no body '{}'{}", node.scalar,
                              core::did_you_mean_or_list(node.scalar, *context.bodies)));
  }
  return node.scalar;
}

model::BodySprings read_held(ScenarioContext& context, const YamlNode& node) {
  model::BodySprings hold = model::read_hold(node, context.diagnostics);
  if (context.bodies && !hold.body.name.empty()) {
    model::check_links({hold.body}, *context.bodies, context.diagnostics);
  }
  return hold;
}

std::string read_call(ScenarioContext& context, const YamlNode& node) {
  if (!core::expect_scalar(node, "the name of a function", context.diagnostics)) return {};
  if (std::ranges::find(context.functions, node.scalar) == context.functions.end()) {
    context.error(node.mark, "unknown-function",
                  fmt::format("unknown function '{}': no file of `scripts` defines it{}",
                              node.scalar, core::did_you_mean(node.scalar, context.functions)));
  }
  return node.scalar;
}

ScriptedPush read_push(ScenarioContext& context, const YamlNode& node) {
  ScriptedPush push;
  if (!core::expect_map(node, "a push: {force: 40 N, for: 100 ms, direction: 90 deg}",
                        context.diagnostics)) {
    return push;
  }
  core::check_keys(node, kPushKeys, context.diagnostics);
  if (const YamlNode* body = node.find("body")) push.body = read_body(context, *body);
  if (const YamlNode* force = core::require_key(node, "force", context.diagnostics)) {
    push.force =
        core::read_bounded(*force, core::kForce, 0.0, 1e6, context.diagnostics).value_or(0.0);
  }
  if (const YamlNode* time = core::require_key(node, "for", context.diagnostics)) {
    push.duration = read_duration(context, *time).value_or(0.0);
  }
  constexpr double kTurn = 2.0 * std::numbers::pi;
  if (const YamlNode* direction = node.find("direction")) {
    push.direction = core::read_bounded(*direction, core::kNone, -kTurn, kTurn, context.diagnostics,
                                        "an angle (in rad, or with its unit: 90 deg)")
                         .value_or(0.0);
  }
  if (const YamlNode* elevation = node.find("elevation")) {
    push.elevation =
        core::read_bounded(*elevation, core::kNone, -0.25 * kTurn, 0.25 * kTurn,
                           context.diagnostics, "an angle from -90 deg (down) to 90 deg (up)")
            .value_or(0.0);
  }
  if (const YamlNode* point = node.find("point")) {
    push.point = core::read_vector3(*point, core::kLength, context.diagnostics);
    constexpr double kFar = 10.0;  // m
    if (push.point &&
        std::ranges::any_of(*push.point, [](double x) { return std::abs(x) > kFar; })) {
      context.error(point->mark, "out-of-range", "expected a point of the body, within 10 m");
    }
  }
  return push;
}

// A parameter without unit accepts any quantity, a planner's goal a length.
std::optional<double> read_new_value(ScenarioContext& context, const YamlNode& node,
                                     const ParameterInfo& info) {
  core::Dimension dimension = info.dimension;
  if (info.bare && !info.gain) {
    const auto& planners = context.scenario.behavior->planners;
    const bool goal = std::ranges::any_of(
        planners, [&info](const auto& planner) { return planner.goal_slot == info.slot; });
    if (!goal) {
      const auto any = core::read_any_quantity(node, context.diagnostics);
      return any ? std::optional(any->value) : std::nullopt;
    }
    dimension = core::kLength;
  }
  return core::read_quantity(node, dimension, context.diagnostics);
}

void read_value(ScenarioContext& context, const YamlNode& node, const ParameterInfo& info,
                std::vector<double>& values) {
  const auto value = read_new_value(context, node, info);
  if (!value) return;
  const std::string unit = core::unit_text(info.dimension);
  if (info.has_range() && (*value < info.min || *value > info.max)) {
    context.error(node.mark, "out-of-range",
                  fmt::format("expected '{}' from {} to {}{}{}, got {}", info.name, info.min,
                              info.max, unit.empty() ? "" : " ", unit, core::describe(node)));
  }
  values.push_back(*value);
}

std::vector<double> read_values(ScenarioContext& context, const YamlNode& node,
                                const ParameterInfo& info) {
  std::vector<double> values;
  if (!node.is_sequence()) {
    read_value(context, node, info, values);
    if (info.size > 1 && !info.gain) {
      context.error(node.mark, "expected",
                    fmt::format("expected {} values for '{}', [X, Y], or one by its name, {}; one "
                                "number for all is for gains",
                                info.size, info.name, value_name(info, 0)));
      return {};
    }
    if (values.size() == 1) values.resize(static_cast<std::size_t>(info.size), values[0]);
    return values;
  }
  if (static_cast<int>(node.items.size()) != info.size) {
    context.error(node.mark, "size",
                  fmt::format("expected {} value{} for '{}', got {}", info.size,
                              info.size == 1 ? "" : "s", info.name, node.items.size()));
    return values;
  }
  for (const YamlNode& item : node.items) read_value(context, item, info, values);
  return values;
}

// Parameters and gains by name; a live edit may change only live parameters.
std::vector<behaviors::SlotValue> read_changes(ScenarioContext& context, const YamlNode& node,
                                               bool edit) {
  std::vector<behaviors::SlotValue> changes;
  if (!core::expect_map(node, "new values by name: {NAME: VALUE}", context.diagnostics)) return {};
  if (node.entries.empty()) context.error(node.mark, "empty-value", "nothing is changed");
  if (context.names == nullptr) return {};
  const Behavior& behavior = *context.scenario.behavior;
  for (const core::YamlEntry& entry : node.entries) {
    const auto [parameter, component] = behavior.find_parameter_part(entry.key);
    if (parameter < 0) {
      std::vector<std::string> names;
      for (const ParameterInfo& info : behavior.parameters) names.push_back(info.name);
      context.error(
          entry.key_mark, "unknown-parameter",
          fmt::format("unknown parameter '{}'{}", entry.key, core::did_you_mean(entry.key, names)));
      continue;
    }
    ParameterInfo info = behavior.parameters[static_cast<std::size_t>(parameter)];
    if (info.at_start) {
      context.error(entry.key_mark, "misplaced-name",
                    fmt::format("parameter '{}' is taken when the run starts: write it in the "
                                "behavior, or under the scenario's own 'set'",
                                info.name));
      continue;
    }
    if (edit && !info.live) {
      context.error(entry.key_mark, "misplaced-name",
                    fmt::format("parameter '{}' is not live: write it under 'set'{}", info.name,
                                info.variable ? " (an action sets it, so it cannot be live)"
                                              : ", or give it a range and 'live: true'"));
      continue;
    }
    if (component >= 0) {  // `goal.y` is read like a scalar parameter
      info.name = entry.key;
      info.size = 1;
    }
    int slot = info.slot + std::max(component, 0);
    for (const double value : read_values(context, entry.value, info)) {
      changes.push_back({slot++, value});
    }
  }
  return changes;
}

// What begins at a time must end before the run does; at an event or place it may begin too late.
void check_end(ScenarioContext& context, const YamlNode& node, const ScriptEntry& entry,
               double lasts) {
  const double end = context.scenario.duration;
  constexpr double kRounding = 1e-9;  // s
  if (entry.moment.kind != Moment::Kind::time || end <= 0.0) return;
  if (entry.moment.time + lasts <= end + kRounding) return;
  context.error(node.mark, "out-of-range",
                fmt::format("{} from {:g} s on ends behind the end of the run, which lasts {:g} s",
                            core::describe(node), entry.moment.time, end));
}

// `over` applies to edits, `for` to entries with a duration.
void read_lasting(ScenarioContext& context, const YamlNode& node, ScriptEntry& entry) {
  const auto misplaced = [&](const char* key, const char* beside) {
    for (const core::YamlEntry& written : node.entries) {
      if (written.key != key) continue;
      context.error(written.key_mark, "misplaced-key",
                    fmt::format("'{}' has a meaning only beside {}", key, beside));
    }
  };
  if (const YamlNode* over = node.find("over")) {
    entry.over =
        core::read_bounded(*over, core::kTime, 0.0, 1e6, context.diagnostics).value_or(0.0);
    check_end(context, *over, entry, entry.over);
    if (node.find("edit") == nullptr) misplaced("over", "'edit'");
  }
  if (const YamlNode* time = node.find("for")) {
    entry.duration = read_duration(context, *time);
    check_end(context, *time, entry, entry.duration.value_or(0.0));
    if (node.find("fault") == nullptr && node.find("hold") == nullptr) {
      misplaced("for", node.find("push") == nullptr ? "'fault' or 'hold'"
                                                    : "'fault' or 'hold': a push has its own");
    }
  }
}

void read_entry(ScenarioContext& context, const YamlNode& node) {
  if (!core::expect_map(node, "an entry of the script: {at: 3 s, raise: EVENT}",
                        context.diagnostics)) {
    return;
  }
  core::check_keys(node, kScriptKeys, context.diagnostics);
  ScriptEntry entry;
  entry.mark = node.mark;
  if (const YamlNode* optional = node.find("optional")) {
    entry.optional = core::read_bool(*optional, context.diagnostics).value_or(false);
  }
  read_moment(context, node, entry.moment);
  const std::vector<std::string> actions = {"push",  "edit", "set", "raise",
                                            "fault", "hold", "call"};
  const bool acts = std::ranges::any_of(
      actions, [&node](const std::string& key) { return node.find(key) != nullptr; });
  if (!acts) expect_one_of(context, node, actions);
  const bool has_robot = context.names == nullptr || context.scenario.behavior->has_robot;
  for (const char* key : {"push", "hold"}) {
    const YamlNode* value = node.find(key);
    if (value == nullptr || has_robot) continue;
    context.error(value->mark, "needs-robot", fmt::format("'{}' needs a robot", key));
  }
  if (const YamlNode* push = node.find("push")) entry.push = read_push(context, *push);
  if (const YamlNode* edit = node.find("edit")) entry.edit = read_changes(context, *edit, true);
  if (const YamlNode* set = node.find("set")) entry.set = read_changes(context, *set, false);
  if (const YamlNode* raise = node.find("raise")) entry.raise = read_raise(context, *raise);
  if (const YamlNode* hold = node.find("hold")) entry.hold = read_held(context, *hold);
  if (const YamlNode* call = node.find("call")) entry.call = read_call(context, *call);
  if (const YamlNode* fault = node.find("fault")) {
    const auto choice =
        core::read_choice(*fault, kInjectedFaults, context.diagnostics, "something that fails");
    if (choice) entry.fault = static_cast<InjectedFault>(*choice);
  }
  if (const YamlNode* push = node.find("push"); push != nullptr && push->find("for") != nullptr) {
    check_end(context, *push->find("for"), entry, entry.push->duration);
  }
  read_lasting(context, node, entry);
  context.scenario.script.push_back(std::move(entry));
}

}  // namespace

void load_script(ScenarioContext& context, const YamlNode& node) {
  if (!core::expect_sequence(node, "a list of entries", context.diagnostics)) return;
  for (const YamlNode& item : node.items) read_entry(context, item);
}

std::vector<model::BodySprings> holds_of(const ScenarioDescription& scenario) {
  std::vector<model::BodySprings> holds;
  for (const ScriptEntry& entry : scenario.script) {
    if (entry.hold) holds.push_back(*entry.hold);
  }
  return holds;
}

}  // namespace footfall::lab
