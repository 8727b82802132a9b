// Reasons against a live edit, as text; see door.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units/units.h"
#include "engine/edits/door.h"

namespace footfall::engine {
namespace {

using behaviors::Behavior;
using behaviors::ParameterInfo;

constexpr double kLongestRamp = 1e6;  // s

bool may_write_all(EditSource source) {
  return source == EditSource::set || source == EditSource::command;
}

std::string with_unit(double value, const ParameterInfo& info) {
  const std::string unit = core::unit_text(info.dimension);
  return fmt::format("{:g}{}{}", value, unit.empty() ? "" : " ", unit);
}

// One value of a parameter: finite, within its range; a gain without range must not be negative.
void check_value(const ParameterInfo& info, int component, double value,
                 std::vector<std::string>& reasons) {
  const std::string name = value_name(info, component);
  if (!std::isfinite(value)) {
    reasons.push_back(fmt::format("{}: {:g} is not a finite number", name, value));
  } else if (info.has_range() && (value < info.min || value > info.max)) {
    reasons.push_back(fmt::format("{}: {} is out of its range, {} to {}", name,
                                  with_unit(value, info), with_unit(info.min, info),
                                  with_unit(info.max, info)));
  } else if (!info.has_range() && info.gain && value < 0.0) {
    reasons.push_back(
        fmt::format("{}: {} is negative: a gain is 0 or more", name, with_unit(value, info)));
  }
}

void check_liveness(const ParameterInfo& info, EditSource source,
                    std::vector<std::string>& reasons) {
  if (info.live || (may_write_all(source) && !info.at_start)) return;
  reasons.push_back(info.name + ": not live, because " + reason_not_live(info));
}

// Checks the values of a batch, slot by slot; a reason that concerns a whole parameter is given
// once.
void check_values(const Behavior& behavior, const EditBatch& batch,
                  std::vector<std::string>& reasons) {
  int last = -1;
  std::vector<std::uint8_t> given(behavior.values.size());
  for (const auto& [slot, value] : batch.values) {
    const int parameter = behavior.parameter_of_slot(slot);
    if (parameter < 0) {
      reasons.push_back(
          fmt::format("no value {}: the behavior has {}", slot, behavior.values.size()));
      continue;
    }
    const ParameterInfo& info = behavior.parameters[static_cast<std::size_t>(parameter)];
    if (parameter != last) check_liveness(info, batch.source, reasons);
    last = parameter;
    check_value(info, slot - info.slot, value, reasons);
    std::uint8_t& before = given[static_cast<std::size_t>(slot)];
    if (before != 0) reasons.push_back(info.name + ": given twice");
    before = 1;
  }
}

void check_events(const Behavior& behavior, const EditBatch& batch,
                  std::vector<std::string>& reasons) {
  if (batch.events.size() > kMaxEditEvents) {
    reasons.push_back(
        fmt::format("{} events: at most {} in one edit", batch.events.size(), kMaxEditEvents));
  }
  for (const int event : batch.events) {
    if (event < 0 || event >= static_cast<int>(behavior.events.size())) {
      reasons.push_back(
          fmt::format("no event {}: the behavior has {}", event, behavior.events.size()));
    } else if (is_built_in_event(behavior, event)) {
      reasons.push_back(fmt::format("{}: raised by the engine only",
                                    behavior.events[static_cast<std::size_t>(event)]));
    }
  }
}

}  // namespace

std::string reason_not_live(const ParameterInfo& info) {
  if (info.variable) return "the behavior's actions set it";
  if (info.at_start) return "only the start takes it: '--set' of a run gives it before";
  if (info.gain) {
    return fmt::format("its table has no range for it: give one under '{}.ranges'",
                       info.of_torque_loop() ? "torque_loop" : "gains");
  }
  return info.has_range() ? "the file does not say so: give it 'live: true'"
                          : "the file does not say so: give it a range and 'live: true'";
}

void add_values(const Behavior& behavior, behaviors::ParameterPart part,
                std::span<const double> values, std::vector<behaviors::SlotValue>& to,
                std::vector<std::string>& reasons) {
  const ParameterInfo& info = behavior.parameters[static_cast<std::size_t>(part.parameter)];
  if (part.component >= info.size || part.component < -1) {
    reasons.push_back(fmt::format("{}: no component {}, it has {} value{}", info.name,
                                  part.component, info.size, info.size == 1 ? "" : "s"));
    return;
  }
  const int wanted = part.component < 0 ? info.size : 1;
  if (std::ssize(values) != wanted) {
    reasons.push_back(fmt::format("{}: expected {} value{}, got {}", info.name, wanted,
                                  wanted == 1 ? "" : "s", values.size()));
    return;
  }
  int slot = info.slot + std::max(0, part.component);
  for (const double value : values) to.push_back({slot++, value});
}

std::vector<std::string> reasons_against(const Behavior& behavior, const EditBatch& batch,
                                         std::uint64_t revision) {
  std::vector<std::string> reasons;
  check_values(behavior, batch, reasons);
  check_events(behavior, batch, reasons);
  if (batch.values.empty() && batch.events.empty()) {
    reasons.emplace_back("nothing is changed or raised");
  }
  if (!(batch.over >= 0.0 && batch.over <= kLongestRamp)) {
    reasons.push_back(
        fmt::format("over: {:g} s is out of its range, 0 s to {:g} s", batch.over, kLongestRamp));
  }
  if (batch.revision && *batch.revision != revision) {
    reasons.push_back(fmt::format("revision {} was expected, {} is in force: read it again",
                                  *batch.revision, revision));
  }
  return reasons;
}

bool is_built_in_event(const Behavior& behavior, int event) {
  const auto in = [event](const std::vector<int>& events) {
    return std::ranges::find(events, event) != events.end();
  };
  const bool done = std::ranges::any_of(
      behavior.states, [event](const auto& state) { return state.done_event == event; });
  const bool planner = std::ranges::any_of(behavior.planners, [event](const auto& info) {
    return event == info.done_event || event == info.late_event || event == info.failed_event;
  });
  return done || planner || event == behavior.error_execution || event == behavior.event_overflow ||
         in(behavior.touchdown_events) || in(behavior.liftoff_events) ||
         in(behavior.fault_events) || in(behavior.changed_events);
}

}  // namespace footfall::engine
