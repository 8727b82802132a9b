// The main part of a scenario file: behavior, robot, world, seeds and duration; see loader.h.
#include "lab/scenario/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "behaviors/load/chart/scripts.h"
#include "behaviors/loader.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/search_folders.h"
#include "core/yaml/layers.h"
#include "lab/scenario/context.h"
#include "lab/scenario/keys.h"
#include "lab/scenario/variation.h"
#include "model/mjcf.h"
#include "model/robot/description.h"
#include "model/variation/variation.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;
using core::YamlNode;

constexpr double kLongestRun = 1e6;  // s
constexpr std::int64_t kGreatestSeed = 1'000'000'000;

bool is_file(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

std::string find_behavior(const ScenarioContext& context, const YamlNode& node,
                          const std::vector<std::string>& search) {
  std::vector<std::string> candidates = {beside(context, node), node.scalar};
  for (const std::string& folder : search) {
    for (const char* ending : {"", ".yaml"}) {
      candidates.push_back(folder + "/behaviors/library/" + node.scalar + ending);
    }
  }
  const auto found = std::ranges::find_if(candidates, is_file);
  return found == candidates.end() ? std::string() : *found;
}

// Adds the errors of another file, at their own positions. Its warnings belong to its own check,
// except for those about values given with the command.
void take_errors(ScenarioContext& context, const core::Diagnostics& from) {
  for (core::Diagnostic item : from.sorted()) {
    const bool error = item.severity == core::Severity::error;
    if (!error && !item.text.starts_with("--set ")) continue;
    if (item.mark.file >= 0) {
      item.mark.file = context.diagnostics.add_file(from.file(item.mark.file));
    }
    if (error) context.diagnostics.error(item.mark, item.id, item.text);
    if (!error) context.diagnostics.warning(item.mark, item.id, item.text);
  }
}

// Finds the robot's file if the scenario names one; false after an error.
bool find_robot(ScenarioContext& context, const YamlNode& root,
                const std::vector<std::string>& search, std::string& file) {
  const YamlNode* node = root.find("robot");
  if (node == nullptr) return true;
  const auto name = core::read_text(*node, context.diagnostics, "the name of a robot");
  if (!name) return false;
  context.scenario.robot = *name;
  file = beside(context, *node);
  if (!is_file(file)) file = model::find_robot_file(*name, search);
  if (!file.empty()) return true;
  context.error(node->mark, "unknown-robot",
                fmt::format("unknown robot '{}': no such file, and no robots/{}/robot.yaml in {}",
                            *name, *name, fmt::join(search, ", ")));
  return false;
}

// Loads the behavior with its signals, and adds the signals that only a complete run has.
void load_named_behavior(ScenarioContext& context, const YamlNode& root,
                         const ScenarioOptions& given) {
  const std::vector<std::string>& search = given.search;
  ScenarioDescription& scenario = context.scenario;
  std::string robot;
  const bool has_robot = find_robot(context, root, search, robot);
  const YamlNode* node = core::require_key(root, "behavior", context.diagnostics);
  if (node == nullptr) return;
  const auto name = core::read_text(*node, context.diagnostics, "the name of a behavior");
  if (!name) return;
  scenario.behavior_name = *name;
  scenario.behavior_path = find_behavior(context, *node, search);
  if (scenario.behavior_path.empty()) {
    context.error(node->mark, "cannot-read",
                  fmt::format("unknown behavior '{}': no such file here, and no "
                              "behaviors/library/{}.yaml in {}",
                              *name, *name, fmt::join(search, ", ")));
  }
  if (scenario.behavior_path.empty() || !has_robot) return;
  static const behaviors::LoadOptions kNoOptions;
  behaviors::LoadOptions options;
  options.search = search;
  options.robot = robot;
  options.set = given.set;
  options.world = given.world;
  core::Diagnostics found;
  scenario.behavior = behaviors::load_behavior(scenario.behavior_path, options, found);
  take_errors(context, found);
  for (int k = 0; k < found.file_count(); ++k) scenario.behavior_files.push_back(found.file(k));
  if (scenario.behavior == nullptr) return;
  scenario.signals = scenario.behavior->signals;
  scenario.signals.add("steps", core::kNone, "steps since the start of the run");
  context.names =
      std::make_unique<behaviors::LoadContext>(*scenario.behavior, kNoOptions, context.diagnostics);
}

void load_bodies(ScenarioContext& context) {
  if (context.names == nullptr || !context.scenario.behavior->has_robot) return;
  const model::RobotDescription& robot = context.scenario.behavior->robot;
  try {
    context.bodies = model::body_names(robot.model_path);
  } catch (const std::runtime_error& error) {
    context.error({context.diagnostics.add_file(robot.path), 0, 0}, "model", error.what());
  }
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc() && end == text.data() + text.size();
  return good && value >= 0 && value <= kGreatestSeed ? std::optional(value) : std::nullopt;
}

// `100..119`
void read_seed_range(ScenarioContext& context, const YamlNode& node) {
  const std::string_view text = node.scalar;
  const std::size_t dots = text.find("..");
  const auto first = whole_number(text.substr(0, dots));
  const auto last = whole_number(text.substr(dots + 2));
  if (!first || !last) {
    core::report_expected(node, "a range of seeds such as 100..119", context.diagnostics);
  } else if (*last < *first) {
    context.error(node.mark, "range",
                  fmt::format("expected the smaller seed first, got '{}'", text));
  } else if (*last - *first >= kMostSeeds) {
    context.error(node.mark, "out-of-range",
                  fmt::format("expected at most {} seeds, got {}", kMostSeeds, *last - *first + 1));
  } else {
    for (std::int64_t seed = *first; seed <= *last; ++seed) {
      context.scenario.seeds.push_back(static_cast<std::uint64_t>(seed));
    }
  }
}

void read_seed(ScenarioContext& context, const YamlNode& node) {
  const auto seed = core::read_integer(node, 0, kGreatestSeed, context.diagnostics);
  if (!seed) return;
  auto& seeds = context.scenario.seeds;
  if (std::ranges::find(seeds, static_cast<std::uint64_t>(*seed)) != seeds.end()) {
    context.error(node.mark, "duplicate", fmt::format("seed {} twice", *seed));
  }
  seeds.push_back(static_cast<std::uint64_t>(*seed));
}

void read_seeds(ScenarioContext& context, const YamlNode& node) {
  context.scenario.seeds.clear();
  if (node.is_scalar() && node.scalar.find("..") != std::string::npos) {
    read_seed_range(context, node);
  } else if (node.is_sequence()) {
    if (node.items.empty()) {
      context.error(node.mark, "empty-value", "no seeds: nothing would be run");
    }
    for (const YamlNode& item : node.items) read_seed(context, item);
  } else {
    read_seed(context, node);
  }
}

void read_labels(ScenarioContext& context, const YamlNode& node) {
  if (!core::expect_sequence(node, "a list of labels", context.diagnostics)) return;
  for (const YamlNode& item : node.items) {
    const auto label = core::read_name(item, context.diagnostics, "a label");
    if (label) context.scenario.labels.push_back(*label);
  }
}

void read_head(ScenarioContext& context, const YamlNode& root) {
  ScenarioDescription& scenario = context.scenario;
  core::Diagnostics& diagnostics = context.diagnostics;
  scenario.name = fs::path(scenario.path).stem().string();
  scenario.world_from = scenario.path;
  if (const YamlNode* node = root.find("name")) {
    scenario.name = core::read_name(*node, diagnostics, "the scenario's name").value_or("");
  }
  if (const YamlNode* node = root.find("doc")) scenario.doc = node->scalar;
  if (const YamlNode* node = root.find("labels")) read_labels(context, *node);
  if (const YamlNode* node = root.find("world")) {
    scenario.world = core::read_text(*node, diagnostics, "the name of a world").value_or("");
    scenario.world_mark = node->mark;
    if (node->mark.file >= 0) scenario.world_from = diagnostics.file(node->mark.file);
  }
  if (const YamlNode* node = root.find("seeds")) {
    read_seeds(context, *node);
    scenario.seeds_mark = node->mark;
  }
  if (const YamlNode* node = core::require_key(root, "for", diagnostics)) {
    scenario.duration = read_duration(context, *node).value_or(0.0);
    scenario.duration_mark = node->mark;
  }
}

void load_functions(ScenarioContext& context, const YamlNode& node) {
  context.scenario.scripts = behaviors::read_script_files(node, context.diagnostics);
  const auto script = std::make_shared<behaviors::Script>(behaviors::ScriptSettings());
  behaviors::run_script_files(context.scenario.scripts, script, context.diagnostics);
  if (script->stopped()) return;
  context.functions = script->functions();
  if (script->patterns().empty()) return;
  context.error(node.mark, "misplaced-name",
                "footfall.on has no meaning in a scenario: write `{on: EVENT, call: FUNCTION}`");
}

}  // namespace

std::string beside(const ScenarioContext& context, const YamlNode& node) {
  const fs::path file = node.mark.file < 0 ? fs::path(context.scenario.path)
                                           : fs::path(context.diagnostics.file(node.mark.file));
  return (file.parent_path() / node.scalar).string();
}

bool expect_one_of(ScenarioContext& context, const YamlNode& map,
                   const std::vector<std::string>& keys) {
  std::string first;
  for (const core::YamlEntry& entry : map.entries) {
    if (std::ranges::find(keys, entry.key) == keys.end()) continue;
    if (!first.empty()) {
      context.error(entry.key_mark, "misplaced-key",
                    fmt::format("'{}' beside '{}': only one is allowed", entry.key, first));
      return false;
    }
    first = entry.key;
  }
  if (!first.empty()) return true;
  const bool misspelt = std::ranges::any_of(
      keys, [&map](const std::string& key) { return core::has_nearly(map, key); });
  if (!misspelt) {
    context.error(map.mark, "missing-key",
                  fmt::format("one of the keys '{}' is missing", fmt::join(keys, "', '")));
  }
  return false;
}

std::optional<double> read_time_in_run(ScenarioContext& context, const YamlNode& node) {
  const auto time =
      core::read_bounded(node, core::kTime, 0.0, kLongestRun, context.diagnostics, "a time");
  const double end = context.scenario.duration;
  if (!time || end <= 0.0 || *time <= end) return time;
  context.error(
      node.mark, "out-of-range",
      fmt::format("{} is behind the end of the run, which lasts {} s", core::describe(node), end));
  return std::nullopt;
}

std::optional<double> read_duration(ScenarioContext& context, const YamlNode& node) {
  const auto time =
      core::read_bounded(node, core::kTime, 0.0, kLongestRun, context.diagnostics, "a time");
  if (!time || *time > 0.0) return time;
  context.error(node.mark, "out-of-range",
                "expected a time above 0 s, got " + core::describe(node));
  return std::nullopt;
}

bool is_scenario_file(const std::string& path) {
  if (!is_file(path)) return false;
  core::Diagnostics ignored;
  const YamlNode root = core::load_yaml_with_base(path, ignored);
  return root.is_map() && !root.entries.empty() && root.entries.front().key == "scenario";
}

namespace {

ScenarioDescription load_tree(const YamlNode& root, const std::string& path,
                              const ScenarioOptions& options, core::Diagnostics& diagnostics) {
  ScenarioDescription scenario;
  scenario.path = path;
  if (!core::check_kind(root, "scenario", 1, diagnostics)) return scenario;
  core::check_keys(root, kScenarioKeys, diagnostics);
  ScenarioContext context{scenario, diagnostics, nullptr, {}, {}};
  read_head(context, root);
  load_named_behavior(context, root, options);
  load_bodies(context);
  if (const YamlNode* variation = root.find("variation")) load_variation(context, *variation);
  if (const YamlNode* scripts = root.find("scripts")) load_functions(context, *scripts);
  if (const YamlNode* script = root.find("script")) load_script(context, *script);
  if (const YamlNode* expect = root.find("expect")) load_expectations(context, *expect);
  if (const YamlNode* golden = root.find("golden")) load_golden(context, *golden);
  scenario.scripts_draw =
      draws_random(scenario.scripts) ||
      (scenario.behavior != nullptr && draws_random(scenario.behavior->scripts));
  for (int k = 0; k < diagnostics.file_count(); ++k) scenario.files.push_back(diagnostics.file(k));
  return scenario;
}

}  // namespace

ScenarioDescription load_scenario(const std::string& path, const ScenarioOptions& options,
                                  core::Diagnostics& diagnostics) {
  return core::load_over_base(
      path, true, diagnostics,
      [&](const YamlNode& root, core::Diagnostics& problems) {
        return load_tree(root, path, options, problems);
      },
      model::prepare_variation);
}

}  // namespace footfall::lab
