// Values after each entry of a script; see edits.h.
#include "lab/scenario/edits.h"

#include <algorithm>

namespace footfall::lab {

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
      for (const auto& [slot, value] : *list) values[static_cast<std::size_t>(slot)] = value;
    }
    const auto errors = edited.errors(values);
    if (errors.empty()) continue;
    diagnostics.error(entry.mark, errors.front().id, "with these values " + errors.front().text);
    return;  // later entries inherit them
  }
}

}  // namespace footfall::lab
