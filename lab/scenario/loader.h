// From a scenario file to a ScenarioDescription, every name checked against what it names. Load
// time only; running scenarios is not here.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/scenario/description.h"

namespace footfall::lab {

struct ScenarioOptions {
  // Folders holding robots/NAME/robot.yaml and behaviors/library/NAME.yaml.
  std::vector<std::string> search;
  // NAME=VALUE of the behavior, as --set has them: instead of what its file says.
  std::vector<std::pair<std::string, std::string>> set{};
};

// Whether a file's first key, or its base's, is `scenario`; false if it cannot be read.
bool is_scenario_file(const std::string& path);

// Problems go to diagnostics, errors of the behavior too; the result is meaningful only without
// errors. The world is left to who knows worlds: see ScenarioDescription::world.
ScenarioDescription load_scenario(const std::string& path, const ScenarioOptions& options,
                                  core::Diagnostics& diagnostics);

}  // namespace footfall::lab
