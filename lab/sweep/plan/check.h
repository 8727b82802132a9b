// Whether every name and value of a sweep means something to what it runs: before the first run.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/sweep/plan/sweep.h"

namespace footfall::lab {

struct SweepCheckOptions {
  std::vector<std::string> search;  // folders holding robots/ and behaviors/library/
  std::vector<std::string> worlds;  // path of each of the sweep's worlds
  // Loads a world and reports what is wrong; from whoever knows worlds.
  std::function<void(const std::string& path, core::Diagnostics&)> check_world;
};

// Problems go to diagnostics, at the value that causes them. Of values written one by one each is
// tried, of grids and draws the least and the greatest, each beside some value of the others: not
// every combination. Fills what the sweep leaves to its scenario (seeds, duration). Returns the
// files that decide what runs, for their content's digest; none after errors.
std::vector<std::string> check_sweep(SweepDescription& sweep, const SweepCheckOptions& options,
                                     core::Diagnostics& diagnostics);

}  // namespace footfall::lab
