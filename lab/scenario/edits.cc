// Values after each entry of a script; see edits.h.
#include "lab/scenario/edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace footfall::lab {
namespace {

// `goal` and `goal.x` in one entry: which of them counts?
void tell_twice(const ScenarioDescription& scenario, const ScriptEntry& entry,
                const std::vector<behaviors::SlotValue>& values, core::Diagnostics& diagnostics) {
  std::set<int> slots;
  for (const auto& [slot, value] : values) {
    if (slots.insert(slot).second) continue;
    const int parameter = scenario.behavior->parameter_of_slot(slot);
    diagnostics.error(
        entry.mark, "duplicate",
        fmt::format("'{}' is given twice",
                    scenario.behavior->parameters[static_cast<std::size_t>(parameter)].name));
    return;
  }
}

}  // namespace

void check_edits(const ScenarioDescription& scenario, const behaviors::PhysicsWorld& world,
                 core::Diagnostics& diagnostics) {
  const auto changes = [](const ScriptEntry& entry) {
    return !entry.edit.empty() || !entry.set.empty();
  };
  if (std::ranges::none_of(scenario.script, changes)) return;
  behaviors::EditedValues edited(*scenario.behavior, world);
  std::vector<double> values = scenario.behavior->values;
  for (const ScriptEntry& entry : scenario.script) {
    if (!changes(entry)) continue;
    for (const auto* list : {&entry.set, &entry.edit}) {
      tell_twice(scenario, entry, *list, diagnostics);
      for (const auto& [slot, value] : *list) values[static_cast<std::size_t>(slot)] = value;
    }
    const auto errors = edited.errors(values);
    if (errors.empty()) continue;
    diagnostics.error(entry.mark, errors.front().id, "with these values " + errors.front().text);
    return;  // later entries inherit them
  }
}

}  // namespace footfall::lab
