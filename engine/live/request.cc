// Resolves names in requests, and describes changes as text; see request.h.
#include "engine/live/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <footfall_lcm/request_t.hpp>

#include "core/diagnostics/did_you_mean.h"
#include "core/index.h"
#include "core/text/printable.h"
#include "core/units/units.h"

namespace footfall::engine {
namespace {

using behaviors::Behavior;
using behaviors::ParameterInfo;

constexpr std::size_t kMaxName = 96;       // bytes, for a name in a text
constexpr std::size_t kMaxReasons = 32;    // in one answer
constexpr std::size_t kMaxReason = 480;    // bytes
constexpr std::size_t kMaxMentioned = 16;  // in one text
constexpr std::size_t kFewChanges = 32;    // always evaluated

std::string unknown(const char* what, const std::string& name,
                    const std::vector<std::string>& known) {
  const std::string shown = core::printable(name, kMaxName);
  return fmt::format("no {} '{}'{}", what, shown, core::did_you_mean(shown, known));
}

std::string number_with_unit(double value, core::Dimension dimension) {
  // Short times are displayed in ms.
  if (dimension == core::kTime && std::abs(value) < 1.0) return fmt::format("{:g} ms", 1e3 * value);
  const std::string unit = core::unit_text(dimension);
  return fmt::format("{:g}{}{}", value, unit.empty() ? "" : " ", unit);
}

// Removes and describes the first value of a batch, or all values of a parameter if they are
// consecutive.
std::string cut_change(const Behavior& behavior, std::span<const behaviors::SlotValue>& values) {
  const int slot = values.front().slot;
  const ParameterInfo& info = behavior.parameters[at(behavior.parameter_of_slot(slot))];
  std::size_t count = 0;
  while (count < std::min(values.size(), at(info.size)) &&
         values[count].slot == info.slot + static_cast<int>(count)) {
    ++count;
  }
  const bool whole = count == at(info.size);
  if (!whole) count = 1;
  const std::string text = whole ? info.name : value_name(info, slot - info.slot);
  std::string list;
  for (const auto& [ignored, value] : values.first(count)) {
    list += (list.empty() ? "" : ", ") + number_with_unit(value, info.dimension);
  }
  values = values.subspan(count);
  return text + " = " + (count == 1 ? list : "[" + list + "]");
}

}  // namespace

LiveNames::LiveNames(const Behavior& behavior) {
  for (std::size_t i = 0; i < behavior.parameters.size(); ++i) {
    const ParameterInfo& info = behavior.parameters[i];
    if (!info.live) continue;
    parameters.push_back(static_cast<int>(i));
    parameter_names.push_back(info.name);
    value_count += at(info.size);
  }
  for (std::size_t i = 0; i < behavior.events.size(); ++i) {
    if (is_built_in_event(behavior, static_cast<int>(i))) continue;
    events.push_back(static_cast<int>(i));
    event_names.push_back(behavior.events[i]);
  }
}

EditBatch read_edit(const Behavior& behavior, const LiveNames& names,
                    const footfall_lcm::request_t& request, std::vector<std::string>& reasons) {
  EditBatch batch;
  batch.over = request.over;
  // No value may be given twice, so more changes than values are always an error.
  if (const std::size_t most = std::max(names.value_count, kFewChanges);
      request.changes.size() > most) {
    reasons.push_back(
        fmt::format("{} changes: at most {} in one edit", request.changes.size(), most));
  } else {
    for (const footfall_lcm::change_t& change : request.changes) {
      const behaviors::ParameterPart part = behavior.find_parameter_part(change.name);
      if (part.parameter < 0) {
        const auto choices = estimator_choices();
        const bool chosen =
            behavior.has_robot && std::ranges::find(choices, change.name) != choices.end();
        reasons.push_back(chosen
                              ? fmt::format("{}: not live, because {}", change.name, kChosenBefore)
                              : unknown("parameter", change.name, names.parameter_names));
        continue;
      }
      // `goal.y` already names a component; a component of it is an error.
      const bool twice = part.component >= 0 && change.component >= 0;
      if (twice) reasons.push_back(core::printable(change.name, kMaxName) + ": is one value");
      const int component = part.component >= 0 ? part.component : change.component;
      add_values(behavior, {part.parameter, component}, change.values, batch.values, reasons);
    }
  }
  if (request.events.size() > kMaxEditEvents) {
    reasons.push_back(
        fmt::format("{} events: at most {} in one edit", request.events.size(), kMaxEditEvents));
    return batch;
  }
  for (const std::string& name : request.events) {
    const int event = behavior.find_event(name);
    if (event < 0) {
      reasons.push_back(unknown("event", name, names.event_names));
    } else {
      batch.events.push_back(event);
    }
  }
  return batch;
}

std::string change_text(const Behavior& behavior, const EditBatch& batch, double ramp) {
  std::string text;
  const auto add = [&text](const std::string& part) {
    text += text.empty() ? "" : ", ";
    text += part;
  };
  std::span<const behaviors::SlotValue> rest = batch.values;
  std::size_t changes = 0;
  for (; !rest.empty(); ++changes) {
    const std::string change = cut_change(behavior, rest);
    if (changes < kMaxMentioned) add(change);
  }
  if (changes > kMaxMentioned) add(fmt::format("{} more", changes - kMaxMentioned));
  if (ramp > 0.0 && !batch.values.empty()) {
    text += " over " + number_with_unit(ramp, core::kTime);
  }
  for (const int event : batch.events) add("raise " + behavior.events[at(event)]);
  return text;
}

std::vector<std::string> shortened(std::vector<std::string> reasons) {
  for (std::string& reason : reasons) reason = core::printable(reason, kMaxReason);
  if (reasons.size() > kMaxReasons) {
    const std::size_t missing = reasons.size() - kMaxReasons;
    reasons.resize(kMaxReasons);
    reasons.push_back(fmt::format("and {} more", missing));
  }
  return reasons;
}

}  // namespace footfall::engine
