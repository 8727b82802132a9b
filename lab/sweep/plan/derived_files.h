// What the runs of a sweep are told to run: the behavior or scenario itself, or a scenario or world
// derived from it (with `base:`) where the sweep changes what no option of `footfall run` changes.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/yaml/yaml.h"
#include "lab/sweep/plan/sweep.h"

namespace footfall::lab {

struct SweepTarget {
  std::string path;       // of the behavior or scenario
  bool scenario = false;  // which of them
  std::string world;      // path; empty: its own. Said by the scenario if it is one
  std::vector<std::pair<std::string, std::string>> set;  // what remains for --set
};

class SweepFiles {
 public:
  // Derived files go to `folder`, which is made when the first is written. worlds: the path of each
  // of the sweep's worlds. Throws std::runtime_error if the scenario cannot be read.
  SweepFiles(const SweepDescription& sweep, std::string folder, std::vector<std::string> worlds);

  // Writes what is missing. Throws std::runtime_error, `script.3.push.force: ...` if the scenario
  // has no such place.
  SweepTarget target(const SweepRun& run);

 private:
  std::string derived_scenario(const SweepRun& run, const SweepTarget& target);
  std::string derived_world(const SweepRun& run, const std::string& base);
  std::string write(const core::YamlNode& root, const char* kind);

  const SweepDescription& sweep_;
  std::string folder_;
  std::vector<std::string> worlds_;
  core::YamlNode scenario_;  // with its bases
  std::set<std::string> written_;
  bool any_fault_ = false, any_script_ = false;
};

// Of which kind the name of an axis is.
bool is_script_axis(const std::string& name);
bool is_world_axis(const std::string& name);

// The whole command of a run.
std::vector<std::string> command_of(const std::string& program, const SweepDescription& sweep,
                                    const SweepRun& run, const SweepTarget& target);

}  // namespace footfall::lab
