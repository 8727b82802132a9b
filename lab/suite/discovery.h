// Finds, selects and shards the scenario files of a suite. Before any run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lab/suite/suite.h"

namespace footfall::lab {

// The first key of a YAML file, or of its base if it begins with one; empty if unreadable.
std::string first_key(const std::string& path, const std::vector<std::string>& bases = {});

// The scenario files among `arguments`: files as given; for folders all .yaml files below whose
// first key is `scenario`, sorted by name. Throws std::runtime_error for a path that does not
// exist.
std::vector<std::string> find_scenarios(const std::vector<std::string>& arguments);

struct SuiteSelection {
  std::string filter;                // glob on names or paths; empty: all
  std::vector<std::string> labels;   // at least one of them; empty: all
  std::vector<std::string> paths;    // only these; empty: all
  int shard = 1, shards = 1;         // this shard (from 1) of how many
  std::vector<std::uint64_t> seeds;  // replace the scenarios' seeds; empty: keep them
};

// Loads each file and drops those not selected. A file with errors stays, with its errors as text:
// it is a failing test. `search`: folders with robots/ and behaviors/library/.
std::vector<SuiteScenario> load_suite(const std::vector<std::string>& files,
                                      const SuiteSelection& selection,
                                      const std::vector<std::string>& search);

// Shards of about equal simulated time, the same on every machine; a scenario is never divided,
// because its expectations are judged over all its seeds.
std::vector<SuiteScenario> shard_of(std::vector<SuiteScenario> scenarios, int shard, int shards);

// `A`, `A..B`, or several of them with commas, each seed once; nullopt if malformed.
std::optional<std::vector<std::uint64_t>> parse_seeds(const std::string& text);

}  // namespace footfall::lab
