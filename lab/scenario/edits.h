// Edits of a scenario's script against physics: what `run --set` refuses, `edit` and `set` do not
// bring about either. Load time only.
#pragma once

#include "behaviors/check/physics/check.h"
#include "core/diagnostics/diagnostics.h"
#include "lab/scenario/description.h"

namespace footfall::lab {

// Judges the values after each entry of the script, in its order; errors are at the entries. For a
// scenario without errors so far.
void check_edits(const ScenarioDescription& scenario, const behaviors::PhysicsWorld& world,
                 core::Diagnostics& diagnostics);

}  // namespace footfall::lab
