// The files that the runs of a sweep use: the behavior or scenario itself, or a derived scenario or
// world (with `base:`) for changes that no option of `footfall run` can make.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/yaml/yaml.h"
#include "lab/sweep/plan/sweep.h"

namespace footfall::lab {

struct SweepTarget {
  std::string path;       // path of the behavior or scenario
  bool scenario = false;  // true for a scenario
  std::string world;      // path; empty: the default. For a scenario, set in its file
  std::vector<std::pair<std::string, std::string>> set;  // for --set
};

class SweepFiles {
 public:
  // Derived files are written to `folder`, which is created when needed. worlds: the path of each
  // of the sweep's worlds. Throws std::runtime_error if the scenario cannot be read.
  SweepFiles(const SweepDescription& sweep, std::string folder, std::vector<std::string> worlds);

  // Writes missing files. Throws std::runtime_error, `script.3.push.force: ...` if the scenario has
  // no such entry.
  SweepTarget target(const SweepRun& run);

 private:
  std::string derived_scenario(const SweepRun& run, const SweepTarget& target);
  std::string derived_world(const SweepRun& run, const std::string& base);
  std::string write(const core::YamlNode& root, const char* kind);

  const SweepDescription& sweep_;
  std::string folder_;
  std::vector<std::string> worlds_;
  core::YamlNode scenario_;  // merged with its bases
  std::set<std::string> written_;
  bool any_fault_ = false, any_of_scenario_ = false;
};

// Whether an axis name refers to the scenario's script.
bool is_script_axis(const std::string& name);
bool is_world_axis(const std::string& name);
// `variation.KEY`: of the scenario, over its world's.
bool is_variation_axis(const std::string& name);
bool is_scenario_axis(const std::string& name);  // one of its script or its variation

// The complete command line of a run.
std::vector<std::string> command_of(const std::string& program, const SweepDescription& sweep,
                                    const SweepRun& run, const SweepTarget& target);

}  // namespace footfall::lab
