// A sweep ready to run: loaded, worlds found, everything checked.
#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "lab/sweep/plan/loader.h"

namespace footfall::apps {

struct PreparedSweep {
  lab::SweepDescription sweep;
  std::vector<std::string> worlds;  // path of each of the sweep's worlds
  std::vector<std::string> inputs;  // files that determine the runs
};

// Adds problems to diagnostics.
PreparedSweep prepare_sweep(lab::SweepDescription sweep, core::Diagnostics& diagnostics);
// For `footfall check`.
void check_sweep_file(const std::string& path, core::Diagnostics& diagnostics);
// Path of a world beside the file that names it, or found by name; empty if absent.
std::string find_world(const std::string& beside, const std::string& name);
// Digest of the contents of files, in this order.
std::string digest_of_files(const std::vector<std::string>& paths);

}  // namespace footfall::apps
