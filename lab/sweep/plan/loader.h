// From a sweep file, or the options of the command line, to a SweepDescription. Load time only.
#pragma once

#include <string>
#include <vector>

#include "core/yaml/yaml.h"
#include "lab/sweep/plan/sweep.h"

namespace footfall::lab {

struct SweepOptions {
  std::vector<std::string> search;  // folders holding behaviors/library/NAME.yaml
};

// The form of the file and the number of runs; whether its names mean something is
// check_sweep's. The result is meaningful only without errors.
SweepDescription load_sweep(const std::string& path, const SweepOptions& options,
                            core::Diagnostics& diagnostics);
// The same from a tree: the command line makes one.
SweepDescription read_sweep(const core::YamlNode& root, const std::string& path,
                            const SweepOptions& options, core::Diagnostics& diagnostics);

// What the command line says, each as in a file or shorter.
struct SweepArguments {
  std::string what;                 // behavior or scenario
  std::vector<std::string> vary;    // NAME=130ms..160ms:4, NAME=[200, 220]
  std::vector<std::string> zip;     // NAME=[1, 2]
  std::vector<std::string> sample;  // NAME=uniform(1, 2), NAME={normal: [1, 0.1], within: ..}
  std::string count, sample_seed, method;  // of samples; may be empty
  std::string seeds, faults, worlds, robot, duration, timeout;
  std::vector<std::string> figures;
};

// The tree of a sweep file that says the same.
core::YamlNode sweep_tree(const SweepArguments& arguments, bool scenario,
                          core::Diagnostics& diagnostics);

}  // namespace footfall::lab
