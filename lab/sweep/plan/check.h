// Checks before the first run that every name and value of a sweep is valid.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "behaviors/check/physics/check.h"
#include "lab/scenario/description.h"
#include "lab/sweep/plan/sweep.h"

namespace footfall::lab {

struct SweepCheckOptions {
  std::vector<std::string> search;  // folders with robots/ and behaviors/library/
  std::vector<std::string> worlds;  // path of each of the sweep's worlds
  // Loads a world as it is for a scenario (an empty one: none) and for a behavior (may be null),
  // reports its errors and says what the physics checks take from it; supplied by the caller,
  // because the loader is in sim.
  std::function<behaviors::PhysicsWorld(const std::string& path, const ScenarioDescription&,
                                        const behaviors::Behavior*, core::Diagnostics&)>
      check_world;
};

// Reports problems at the sweep value that causes them. Individually listed values are all tried,
// of grids and samples the smallest and the largest, each together with some value of the other
// axes: not every combination. Fills settings that the sweep leaves to its scenario (seeds,
// duration). Returns the files that determine the runs, for a digest of their content; empty after
// errors.
std::vector<std::string> check_sweep(SweepDescription& sweep, const SweepCheckOptions& options,
                                     core::Diagnostics& diagnostics);

}  // namespace footfall::lab
