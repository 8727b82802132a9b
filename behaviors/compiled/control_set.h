// A control spec as the whole-body controller takes it, at rest: references, gains and internal
// forces are 0, weights are those of the first tick. For questions about a law that is not in
// force: ranks, torques at rest.
#pragma once

#include "behaviors/compiled/behavior.h"
#include "tasks/active_set.h"
#include "tasks/whole_body_controller.h"

namespace footfall::behaviors {

void fill_control_set(const Behavior& behavior, const ControlSpec& spec, tasks::ControlSet& set);

// Capacities that a behavior needs at worst, for a whole-body controller.
tasks::ControllerSizes controller_sizes(const Behavior& behavior);

// Whether a law (index into Behavior::controls) relies on the contact, or is loading it.
bool law_holds(const Behavior& behavior, int control, int contact) noexcept;

}  // namespace footfall::behaviors
