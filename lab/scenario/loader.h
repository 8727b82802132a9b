// Loads a scenario file into a ScenarioDescription and checks every name. Load time only; does not
// run scenarios.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lab/scenario/description.h"

namespace footfall::lab {

struct ScenarioOptions {
  // Folders with robots/NAME/robot.yaml and behaviors/library/NAME.yaml.
  std::vector<std::string> search;
  // Behavior values NAME=VALUE, as with --set; they replace the file's values.
  std::vector<std::pair<std::string, std::string>> set{};
  // LoadOptions::world of its behavior; whoever has loaded the scenario's world knows it.
  std::function<void(model::RobotDescription&, core::Diagnostics&)> world{};
};

// Whether the first key of the file or its base is `scenario`; false if unreadable.
bool is_scenario_file(const std::string& path);

// Adds problems to diagnostics, including errors of the behavior; the result is valid only without
// errors. The world is not loaded here: see ScenarioDescription::world.
ScenarioDescription load_scenario(const std::string& path, const ScenarioOptions& options,
                                  core::Diagnostics& diagnostics);

// The holds of its script.
std::vector<model::BodySprings> holds_of(const ScenarioDescription& scenario);

}  // namespace footfall::lab
