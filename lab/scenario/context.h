// State shared by the parts of the scenario loader; see loader.h.
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
  // Resolves state names in the behavior; null if it could not be loaded, then only the form of the
  // file is checked.
  std::unique_ptr<behaviors::LoadContext> names;
  std::optional<std::vector<std::string>> bodies;  // bodies of the robot's model, if readable
  std::vector<std::string> functions;              // functions defined in `scripts`

  void error(core::Mark mark, std::string_view id, std::string text) {
    diagnostics.error(mark, id, std::move(text));
  }
};

// Path of NAME relative to the file that contains the node.
std::string beside(const ScenarioContext& context, const core::YamlNode& node);
// Requires exactly one of these keys: error missing-key at the map, misplaced-key at the second.
bool expect_one_of(ScenarioContext& context, const core::YamlNode& map,
                   const std::vector<std::string>& keys);
// A time within the run: not negative, not after its end.
std::optional<double> read_time_in_run(ScenarioContext& context, const core::YamlNode& node);
// A positive time.
std::optional<double> read_duration(ScenarioContext& context, const core::YamlNode& node);

void load_script(ScenarioContext& context, const core::YamlNode& node);        // script.cc
void load_expectations(ScenarioContext& context, const core::YamlNode& node);  // expect.cc
void load_golden(ScenarioContext& context, const core::YamlNode& node);        // golden.cc
void load_variation(ScenarioContext& context, const core::YamlNode& node);     // variation.cc
// Warns about a condition on every tick that a state fails in which its signal has no value, at
// `mark` (no_value.cc).
void warn_no_value(ScenarioContext& context, const Expectation& expectation, core::Mark mark);

}  // namespace footfall::lab
