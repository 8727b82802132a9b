// What the parts of the scenario loader share; see loader.h.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/load/context.h"
#include "core/yaml/value_reader.h"
#include "lab/scenario/description.h"

namespace footfall::lab {

struct ScenarioContext {
  ScenarioDescription& scenario;
  core::Diagnostics& diagnostics;
  // How names of states are found in the behavior; null if it could not be loaded: then only the
  // form of the file is checked.
  std::unique_ptr<behaviors::LoadContext> names;
  std::optional<std::vector<std::string>> bodies;  // of the robot's model, if it could be read
  std::vector<std::string> functions;              // of `scripts`

  void error(core::Mark mark, std::string_view id, std::string text) {
    diagnostics.error(mark, id, std::move(text));
  }
};

// NAME beside the file in which it is written.
std::string beside(const ScenarioContext& context, const core::YamlNode& node);
// Exactly one of these keys: error missing-key at the map, misplaced-key at the second.
bool expect_one_of(ScenarioContext& context, const core::YamlNode& map,
                   const std::vector<std::string>& keys);
// A time in the run: not negative, not behind its end.
std::optional<double> read_time_in_run(ScenarioContext& context, const core::YamlNode& node);
// A time above zero.
std::optional<double> read_duration(ScenarioContext& context, const core::YamlNode& node);

void load_script(ScenarioContext& context, const core::YamlNode& node);        // script.cc
void load_expectations(ScenarioContext& context, const core::YamlNode& node);  // expect.cc
void load_golden(ScenarioContext& context, const core::YamlNode& node);        // golden.cc

}  // namespace footfall::lab
