// A sweep ready to be run: loaded, its worlds found, everything checked.
#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "lab/sweep/plan/loader.h"

namespace footfall::apps {

struct PreparedSweep {
  lab::SweepDescription sweep;
  std::vector<std::string> worlds;  // path of each of its worlds
  std::vector<std::string> inputs;  // files that decide what runs
};

// Problems go to diagnostics.
PreparedSweep prepare_sweep(lab::SweepDescription sweep, core::Diagnostics& diagnostics);
// For `footfall check`.
void check_sweep_file(const std::string& path, core::Diagnostics& diagnostics);
// Of the files' contents, in their order.
std::string digest_of_files(const std::vector<std::string>& paths);

}  // namespace footfall::apps
