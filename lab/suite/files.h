// Which scenarios a suite has: files that are found, picked, shared out. Before any run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lab/suite/suite.h"

namespace footfall::lab {

// The first key of a YAML file, or of the base that it begins with; empty if it cannot be read.
std::string first_key(const std::string& path, const std::vector<std::string>& bases = {});

// The scenario files among `arguments`: files as they are named, of folders all .yaml files below
// whose first key is `scenario`, by name. Throws std::runtime_error for a path that does not exist.
std::vector<std::string> find_scenarios(const std::vector<std::string>& arguments);

struct SuiteSelection {
  std::string filter;                // glob on names or paths; empty: all
  std::vector<std::string> labels;   // it must have one of them; empty: all
  std::vector<std::string> paths;    // only these; empty: all
  int shard = 1, shards = 1;         // the shard-th of so many parts
  std::vector<std::uint64_t> seeds;  // instead of the scenarios' own; empty: theirs
};

// Loads each file and leaves out what is not selected. A file with errors stays, with its errors as
// text: it is a test that fails. `search`: folders with robots/ and behaviors/library/.
std::vector<SuiteScenario> load_suite(const std::vector<std::string>& files,
                                      const SuiteSelection& selection,
                                      const std::vector<std::string>& search);

// Parts of about equal simulated time, the same on every machine; a scenario is never divided, as
// its expectations are judged over its seeds.
std::vector<SuiteScenario> shard_of(std::vector<SuiteScenario> scenarios, int shard, int shards);

// `A..B` or `A`. Nothing if it is neither.
std::optional<std::vector<std::uint64_t>> parse_seeds(const std::string& text);

}  // namespace footfall::lab
