// A start without a state, told at the place of the file that makes it so.
#pragma once

#include <string>

#include "apps/shared/commands.h"
#include "behaviors/compiled/behavior.h"
#include "engine/tick/control_loop.h"
#include "sim/world/description.h"

namespace footfall::apps {

// `file:line:col: error: why, what to do`: of `sensors: {mocap: ...}` in the world if motion
// capture saw too few markers and the world has it, else of the behavior's estimator.
std::string place_no_state(const engine::NoState& problem, const behaviors::Behavior& behavior,
                           const sim::WorldDescription& world);

// What `work` gives; it begins with the start.
template <typename Work>
auto from_first_state(const behaviors::Behavior& behavior, const sim::WorldDescription& world,
                      const Work& work) {
  try {
    return work();
  } catch (const engine::NoState& problem) {
    throw InputError(place_no_state(problem, behavior, world));
  }
}

}  // namespace footfall::apps
