// The steps from a behavior file to a compiled Behavior, in order; see loader.h.
#include "behaviors/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "behaviors/blame.h"
#include "behaviors/check/structure/structure.h"
#include "behaviors/compile.h"
#include "behaviors/language/language.h"
#include "behaviors/load/chart/steps.h"
#include "behaviors/load/context.h"
#include "behaviors/load/control/steps.h"
#include "behaviors/load/steps.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/search_folders.h"
#include "core/yaml/layers.h"

namespace footfall::behaviors {
namespace {

void load_robot(LoadContext& context, const std::string& path) {
  const core::YamlNode* node = context.section("robot");
  std::string name = context.options.robot;
  if (name.empty() && node == nullptr) return;
  if (name.empty()) {
    const auto text = core::read_text(*node, context.diagnostics, "the name of a robot");
    if (!text) return;
    name = *text;
  }
  context.behavior.has_robot = true;
  const std::vector<std::string>& search = context.options.search;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const std::string beside = folder.empty() ? name : folder + "/" + name;
  const std::vector<std::string> folders = core::search_from(path, search);
  std::string file = model::find_robot_file(name, folders);
  std::error_code unreadable;  // a name too long for a path, a folder closed to us
  if (file.empty() && std::filesystem::is_regular_file(beside, unreadable)) file = beside;
  if (file.empty()) {
    context.error(
        node == nullptr ? core::Mark{} : node->mark, "unknown-robot",
        fmt::format("unknown robot '{}': no such file, and no robots/{}/robot.yaml "
                    "beside this file, above it, or in {}{}",
                    name, name, fmt::join(search, ", "),
                    core::did_you_mean(name, core::names_in(folders, "robots", "robot.yaml"))));
    return;
  }
  context.behavior.robot = model::load_robot(file, context.diagnostics);
  if (context.options.world && !context.diagnostics.has_errors()) {
    context.options.world(context.behavior.robot, context.diagnostics);
  }
  context.behavior.rate_mhz = context.behavior.robot.rate_mhz;
}

// Whether later steps make sense: there is a tree of states, and the robot is known.
bool load_structure(LoadContext& context, const std::string& path) {
  if (!core::check_kind(context.root, "behavior", 1, context.diagnostics)) return false;
  core::check_keys(context.root, kBehaviorKeys, context.diagnostics);
  apply_overrides(context);
  const int before = context.diagnostics.error_count();
  load_robot(context, path);
  const bool robot = context.diagnostics.error_count() == before;
  load_parameters(context);
  const int parameters = context.diagnostics.error_count();
  expand_machine(context);
  context.states_missing = context.diagnostics.error_count() != parameters;
  if (context.machine.name.empty()) return false;
  check_machine_names(context);
  load_states(context);
  return robot;
}

void load_contents(LoadContext& context) {
  load_planners(context);
  load_events(context);
  load_scripts(context);
  load_estimator(context);
  load_signals(context);
  load_gains(context);
  load_torque_loops(context);
  load_transitions(context);
  load_invokes(context);
  load_control(context);
  check_gain_settings(context);
  finish_events(context);
  warn_absences(context);
}

std::unique_ptr<Behavior> load_once(core::YamlNode root, const std::string& path,
                                    const LoadOptions& options, core::Diagnostics& diagnostics) {
  auto behavior = std::make_unique<Behavior>();
  LoadContext context(*behavior, options, diagnostics);
  return compile_behavior(context, std::move(root), path) ? std::move(behavior) : nullptr;
}

// What options.check finds in a behavior, at the values that it follows from.
core::Diagnostics check_loaded(const Behavior& behavior, const core::YamlNode& root,
                               const core::YamlLayers& layers, const std::string& path,
                               const LoadOptions& options, const core::Diagnostics& before,
                               const core::Diagnostics& of_load) {
  core::Diagnostics found = before;
  for (int k = 0; k < of_load.file_count(); ++k) found.add_file(of_load.file(k));
  options.check(behavior, found);
  const auto load = [&](const core::YamlNode& tree, const LoadOptions& with,
                        core::Diagnostics& problems) {
    core::Diagnostics own = before;
    const auto trial = load_once(tree, path, with, own);
    for (int k = 0; k < own.file_count(); ++k) problems.add_file(own.file(k));
    if (trial != nullptr) options.check(*trial, problems);
    for (std::size_t k = before.all().size(); trial == nullptr && k < own.all().size(); ++k) {
      const core::Diagnostic& item = own.all()[k];
      if (item.severity == core::Severity::error) problems.add(item);
    }
    return trial != nullptr;
  };
  return blame_findings(root, layers, options, before, std::move(found), load);
}

void append(core::Diagnostics& to, const core::Diagnostics& from, std::size_t first) {
  for (int k = 0; k < from.file_count(); ++k) to.add_file(from.file(k));
  for (std::size_t k = first; k < from.all().size(); ++k) {
    to.add(from.all()[k]);
  }
}

std::unique_ptr<Behavior> load(core::YamlNode root, const core::YamlLayers& layers,
                               const std::string& path, const LoadOptions& options,
                               core::Diagnostics& diagnostics) {
  core::Diagnostics trial = diagnostics;
  auto behavior = load_once(root, path, options, trial);
  const auto with = [&](const core::YamlNode& tree, const LoadOptions& other,
                        core::Diagnostics& problems) {
    return load_once(tree, path, other, problems) != nullptr;
  };
  if (behavior != nullptr && options.check) {
    const std::size_t first = diagnostics.all().size();
    append(trial, check_loaded(*behavior, root, layers, path, options, diagnostics, trial), first);
  }
  const bool blamed = behavior == nullptr && !options.set.empty() &&
                      blame_overrides(root, options, with, diagnostics);
  if (behavior == nullptr && !blamed && !root.is_null()) {
    trial = core::blame_edits(layers, diagnostics, trial,
                              [&](const core::YamlNode& tree, core::Diagnostics& problems) {
                                with(tree, options, problems);
                              });
  }
  if (!blamed) diagnostics = std::move(trial);
  for (int k = 0; behavior != nullptr && k < diagnostics.file_count(); ++k) {
    if (!diagnostics.file(k).starts_with("--")) behavior->files.push_back(diagnostics.file(k));
  }
  return behavior;
}

}  // namespace

bool compile_behavior(LoadContext& context, core::YamlNode root, const std::string& path) {
  context.behavior.path = path;
  context.behavior.name = std::filesystem::path(path).stem().string();
  if (root.is_null() && context.diagnostics.has_errors()) return false;
  const int before = context.diagnostics.error_count();
  context.root = std::move(root);
  if (const auto* name = context.section("name")) {
    context.behavior.name =
        core::read_text(*name, context.diagnostics, "a name").value_or(context.behavior.name);
  }
  if (load_structure(context, path)) load_contents(context);
  if (context.diagnostics.error_count() == before) check_structure(context);
  return context.diagnostics.error_count() == before;
}

std::unique_ptr<Behavior> load_behavior(const std::string& path, const LoadOptions& options,
                                        core::Diagnostics& diagnostics) {
  core::YamlLayers layers;
  core::YamlNode root = load_tree(path, options, diagnostics, &layers);
  return load(std::move(root), layers, path, options, diagnostics);
}

std::unique_ptr<Behavior> load_behavior_text(std::string_view text, const std::string& name,
                                             const LoadOptions& options,
                                             core::Diagnostics& diagnostics) {
  core::YamlLayers layers;
  core::YamlNode root = load_tree_text(text, name, options, diagnostics, &layers);
  return load(std::move(root), layers, name, options, diagnostics);
}

}  // namespace footfall::behaviors
