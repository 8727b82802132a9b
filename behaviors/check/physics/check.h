// Checks of a behavior's physics before a motor moves: tasks that no contact can produce,
// conflicting tasks, uncontrolled degrees of freedom, references out of reach, internal forces
// outside the friction cone, unstable planners, torque steps at contact changes. Load time only;
// `footfall check` and `footfall run` call it after the loader.
#pragma once

#include "behaviors/compiled/behavior.h"
#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

// Evaluated at the nominal posture of the robot file and at kSeededPostures around it (postures.h):
// an error if a configuration is deficient in all of them, a warning if in some. No effect for a
// behavior without a robot. Throws std::runtime_error with one sentence if the robot's model cannot
// be compiled.
void check_physics(const Behavior& behavior, core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
