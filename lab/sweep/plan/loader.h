// Loads a SweepDescription from a sweep file or from command-line options. Load time only.
#pragma once

#include <string>
#include <vector>

#include "core/yaml/yaml.h"
#include "lab/sweep/plan/sweep.h"

namespace footfall::lab {

struct SweepOptions {
  std::vector<std::string> search;  // folders with behaviors/library/NAME.yaml
};

// Checks the form of the file and the number of runs; check_sweep checks whether its names exist.
// The result is valid only without errors.
SweepDescription load_sweep(const std::string& path, const SweepOptions& options,
                            core::Diagnostics& diagnostics);
// Same from a tree, such as one built from the command line.
SweepDescription read_sweep(const core::YamlNode& root, const std::string& path,
                            const SweepOptions& options, core::Diagnostics& diagnostics);

// Sweep options of the command line, in the notation of a file or shorter.
struct SweepArguments {
  std::string what;                 // behavior or scenario
  std::vector<std::string> vary;    // NAME=130ms..160ms:4, NAME=[200, 220]
  std::vector<std::string> zip;     // NAME=[1, 2]
  std::vector<std::string> sample;  // NAME=uniform(1, 2), NAME={normal: [1, 0.1], within: ..}
  std::string count, sample_seed, method;  // of `sample`; may be empty
  std::string seeds, faults, worlds, robot, duration, timeout;
  std::vector<std::string> figures;
};

// The tree of an equivalent sweep file.
core::YamlNode sweep_tree(const SweepArguments& arguments, bool scenario,
                          core::Diagnostics& diagnostics);

}  // namespace footfall::lab
