// What a behavior asks of its robot's physics, judged before a motor moves: tasks that no contact
// can produce, tasks that fight, freedom that nothing controls, references out of reach, internal
// forces outside the friction cone, planners that diverge, torque steps at changes of contact.
// Load time only; `footfall check` and `footfall run` call it after the loader.
#pragma once

#include "behaviors/compiled/behavior.h"
#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

// Judged at the nominal posture of the robot file and at kSeededPostures around it
// (postures.h): an error if a configuration is deficient in all of them, a warning if in
// some. Nothing to do for a behavior without a robot. Throws std::runtime_error with one clear
// sentence if the robot's model cannot be compiled.
void check_physics(const Behavior& behavior, core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
