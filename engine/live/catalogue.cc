// The catalogue of a run: everything that can be changed, and names of reported quantities; see
// server.h.
#include "engine/live/catalogue.h"

#include <filesystem>
#include <footfall_lcm/catalogue_t.hpp>

#include "core/fault.h"
#include "core/index.h"
#include "core/units/units.h"
#include "engine/live/request.h"

namespace footfall::engine {
namespace {

using behaviors::Behavior;
using behaviors::ParameterInfo;

std::int32_t count_of(const std::vector<std::string>& list) {
  return static_cast<std::int32_t>(list.size());
}

void add_parameter(const Behavior& behavior, const ParameterInfo& info,
                   footfall_lcm::catalogue_t& catalogue) {
  footfall_lcm::parameter_t& out = catalogue.parameters.emplace_back();
  out.name = info.name;
  out.first = static_cast<std::int32_t>(catalogue.values.size());
  out.size = info.size;
  out.unit = core::unit_text(info.dimension);
  out.has_range = info.has_range() ? 1 : 0;
  out.min = info.min;
  out.max = info.max;
  out.gain = info.gain ? 1 : 0;
  out.axes = info.axes;
  out.axis_count = count_of(out.axes);
  out.doc = info.doc;
  for (int slot = info.slot; slot < info.slot + info.size; ++slot) {
    catalogue.values.push_back(behavior.values[at(slot)]);
  }
}

}  // namespace

void fill_names(const Behavior& behavior, const LiveNames& names,
                footfall_lcm::catalogue_t& catalogue) {
  catalogue = {};
  catalogue.behavior = behavior.name;
  catalogue.path = std::filesystem::absolute(behavior.path).lexically_normal().string();
  catalogue.robot = behavior.robot.name;
  catalogue.rate = static_cast<double>(behavior.rate_mhz) * 1e-3;
  for (const int p : names.parameters) {
    add_parameter(behavior, behavior.parameters[at(p)], catalogue);
  }
  catalogue.parameter_count = static_cast<std::int32_t>(catalogue.parameters.size());
  catalogue.value_count = static_cast<std::int32_t>(catalogue.values.size());
  for (const ParameterInfo& info : behavior.parameters) {
    if (info.live) continue;
    catalogue.fixed.push_back(info.name);
    catalogue.fixed_reasons.push_back(reason_not_live(info));
  }
  if (behavior.has_robot) {
    for (const std::string_view choice : engine::estimator_choices()) {
      catalogue.fixed.emplace_back(choice);
      catalogue.fixed_reasons.emplace_back(engine::kChosenBefore);
    }
  }
  catalogue.fixed_count = count_of(catalogue.fixed);
  catalogue.events = names.event_names;
  catalogue.event_docs.resize(catalogue.events.size());
  catalogue.event_count = count_of(catalogue.events);
  for (const auto& state : behavior.states) catalogue.states.push_back(state.path);
  catalogue.state_count = count_of(catalogue.states);
  for (const auto& task : behavior.task_names) catalogue.tasks.push_back(task.name);
  catalogue.task_count = count_of(catalogue.tasks);
  for (const auto& contact : behavior.robot.contacts) catalogue.feet.push_back(contact.name);
  catalogue.foot_count = count_of(catalogue.feet);
  for (const core::SignalInfo& signal : behavior.signals.infos()) {
    catalogue.signals.push_back(signal.name);
    catalogue.signal_units.push_back(core::unit_text(signal.dimension));
  }
  catalogue.signal_count = count_of(catalogue.signals);
  for (int f = 0; f < core::kFaultCount; ++f) {
    catalogue.faults.emplace_back(core::fault_name(static_cast<core::Fault>(f)));
  }
  catalogue.fault_count = count_of(catalogue.faults);
}

}  // namespace footfall::engine
