// `--set world.KEY=VALUE`: settings of the world, told apart from those of the behavior, and those
// that could have no effect refused.
#pragma once

#include "apps/run/run_options.h"
#include "lab/scenario/description.h"
#include "sim/world/description.h"

namespace footfall::apps {

// Moves the settings of the world from `set` to `world_set`. Throws InputError for one without a
// value, for keys that make another world or are set twice, and for what the backend has no use for
// or `--variation off` takes away.
void separate_world_settings(RunOptions& options);

// Throws InputError for draws that the scenario's own `variation:` goes over.
void refuse_shadowed_settings(const RunOptions& options, const lab::ScenarioDescription& scenario);

// What a run is given: on the stub, without another world or model, the robot's own actuators.
sim::WorldSettings world_settings(const RunOptions& options, bool world_given);

// ` actuators.coulomb=2Nm`, for the world's name.
std::string world_settings_text(const RunOptions& options);

}  // namespace footfall::apps
