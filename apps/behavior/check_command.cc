// `footfall check`: all checks that are possible before a motor moves.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/shared/commands.h"
#include "apps/suites/sweep_setup.h"
#include "behaviors/check/actuators/drives.h"
#include "behaviors/check/physics/check.h"
#include "behaviors/loader.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/json_text.h"
#include "core/text/search_folders.h"
#include "core/text/whole_file.h"
#include "lab/scenario/edits.h"
#include "lab/scenario/loader.h"
#include "lab/scenario/variation.h"
#include "lab/suite/discovery.h"
#include "model/check/check.h"
#include "model/control_model.h"
#include "sim/world/description.h"

namespace footfall::apps {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  std::string stdin_name = "stdin";
  std::string robot;  // file or name
  std::string world;  // file or name, in which behaviors are judged
  bool strict = false, json = false;
};

void check_fit(const model::RobotDescription& robot, core::Diagnostics& diagnostics) {
  if (!model::check_model(robot, diagnostics)) return;
  try {
    const model::ControlModel model(robot);
  } catch (const std::exception& error) {
    diagnostics.error({diagnostics.add_file(robot.path), 0, 0}, "model", error.what());
  }
}

// What the checks of one file give and take.
struct Checked {
  const std::string& robot;  // file or name; empty: a behavior's own
  const std::string& world;  // file or name; empty: the default one
  core::Diagnostics& diagnostics;
  std::string not_judged;  // for want of a robot; empty: all was judged
};

void check_robot(const std::string& path, Checked& checked) {
  core::Diagnostics& diagnostics = checked.diagnostics;
  const model::RobotDescription robot = model::load_robot(path, diagnostics);
  if (diagnostics.has_errors()) return;
  check_fit(robot, diagnostics);
  behaviors::check_drives(robot, diagnostics);
}

// What of a world only a robot can judge: the names of its bodies and joints, springs and ropes on
// its masses, actuators with its drives.
std::string needs_robot(const sim::WorldDescription& world) {
  std::vector<std::string> parts;
  if (!world.links.empty() || !world.variation.links.empty()) parts.emplace_back("bodies");
  if (!world.start_joints.node.is_null() || !world.axis_tilts.node.is_null()) {
    parts.emplace_back("joints");
  }
  if (!world.constraints.empty()) parts.emplace_back("constraints");
  if (world.actuators.model != sim::ActuatorModel::ideal) parts.emplace_back("actuators");
  return fmt::format("{}", fmt::join(parts, ", "));
}

// With the world as it is written: errors of a robot's own file are its own check's.
void check_world_on(const std::string& name, const sim::WorldDescription& world,
                    core::Diagnostics& diagnostics) {
  const std::string path = model::find_robot_file(name, search_path());
  if (path.empty()) {
    diagnostics.error(
        {diagnostics.add_file("--robot"), 0, 0}, "cannot-read",
        fmt::format("no such file, and no robot '{}'{}", name,
                    core::did_you_mean_or_list(
                        name, core::names_in(search_path(), "robots", "robot.yaml"))));
    return;
  }
  const model::RobotDescription robot = model::load_robot(path, diagnostics);
  if (!diagnostics.has_errors()) check_world_fits(world, robot, diagnostics);
}

void check_world(const std::string& path, Checked& checked) {
  core::Diagnostics& diagnostics = checked.diagnostics;
  const sim::WorldDescription world = sim::load_world(path, diagnostics, search_path());
  if (diagnostics.has_errors()) return;
  core::Diagnostics refused;  // only refused by `run`: the file itself is correct
  sim::check_supported(world, refused);
  for (core::Diagnostic item : refused.all()) {
    item.text += "; runs refuse this world";
    diagnostics.warning(item.mark, item.id, item.text);
  }
  if (checked.robot.empty()) {
    checked.not_judged = needs_robot(world);
  } else {
    check_world_on(checked.robot, world, diagnostics);
  }
}

// The world of --world, an error if there is none.
std::optional<sim::WorldDescription> named_world(const std::string& name,
                                                 core::Diagnostics& diagnostics) {
  const std::string path = sim::find_world_file(name, search_path());
  if (path.empty()) {
    diagnostics.error(
        {diagnostics.add_file("--world"), 0, 0}, "cannot-read",
        fmt::format("no such file, and no world '{}'{}", name,
                    core::did_you_mean_or_list(name, core::names_in(search_path(), "sim/worlds"))));
    return std::nullopt;
  }
  sim::WorldDescription world = sim::load_world(path, diagnostics, search_path());
  if (diagnostics.has_errors()) return std::nullopt;
  return world;
}

// Loads a behavior with `load`, in the world of --world.
void check_behavior_with(Checked& checked, const std::function<std::unique_ptr<behaviors::Behavior>(
                                               const behaviors::LoadOptions&)>& load) {
  behaviors::LoadOptions options;
  options.search = search_path();
  options.robot = checked.robot;
  std::optional<sim::WorldDescription> world;
  if (!checked.world.empty()) {
    world = named_world(checked.world, checked.diagnostics);
    if (!world) return;
  }
  const auto judged_in = world ? physics_world(*world, false) : behaviors::PhysicsWorld{};
  options.check = behaviors::physics_check(judged_in);
  options.world = judged_in.actuators;
  const auto behavior = load(options);
  if (world && behavior && behavior->has_robot) {
    check_world_fits(*world, behavior->robot, checked.diagnostics);
  }
}

void check_behavior(const std::string& path, Checked& checked) {
  check_behavior_with(checked, [&](const behaviors::LoadOptions& options) {
    return behaviors::load_behavior(path, options, checked.diagnostics);
  });
}

// Checks the world that a scenario names: a file beside it, or one found by name; as the scenario's
// `variation:` makes it.
behaviors::PhysicsWorld check_world_of(const lab::ScenarioDescription& scenario,
                                       core::Diagnostics& diagnostics) {
  if (scenario.world.empty()) return {};
  const std::filesystem::path folder = std::filesystem::path(scenario.world_from).parent_path();
  const std::string beside = sim::find_world_file((folder / scenario.world).string(), {});
  const std::vector<std::string> folders = core::search_from(scenario.world_from, search_path());
  const std::string path = beside.empty() ? sim::find_world_file(scenario.world, folders) : beside;
  if (!path.empty()) {
    sim::WorldDescription world = sim::load_world(path, diagnostics, search_path());
    if (diagnostics.has_errors()) return {};
    world.variation = lab::variation_over(scenario, world.variation);
    lab::warn_late_push(scenario, world.variation, diagnostics);
    lab::warn_alike_seeds(scenario, world.variation, diagnostics);
    const behaviors::Behavior* const behavior = scenario.behavior.get();
    if (behavior != nullptr && behavior->has_robot) {
      check_world_fits(world, behavior->robot, diagnostics, lab::holds_of(scenario));
    }
    return physics_world(world, !lab::holds_of(scenario).empty());
  }
  if (scenario.world_mark.line > 0) {
    diagnostics.error(scenario.world_mark, "cannot-read",
                      fmt::format("unknown world '{}': no such file here, and no "
                                  "sim/worlds/{}.yaml here, above, or in the search path{}",
                                  scenario.world, scenario.world,
                                  core::did_you_mean_or_list(
                                      scenario.world, core::names_in(folders, "sim/worlds"))));
  }
  return {};
}

// The scenario's behavior, in its world, as `run` checks it.
void check_scenario(const std::string& path, Checked& checked) {
  core::Diagnostics& diagnostics = checked.diagnostics;
  lab::ScenarioDescription scenario = lab::load_scenario(path, {search_path()}, diagnostics);
  const behaviors::PhysicsWorld world = check_world_of(scenario, diagnostics);
  if (world.actuators && !diagnostics.has_errors()) {  // once more, with the robot as it is there
    scenario = lab::load_scenario(path, {search_path(), {}, world.actuators}, diagnostics);
  }
  if (diagnostics.has_errors() || scenario.behavior == nullptr) return;
  core::Diagnostics found;  // positions refer to the behavior's files
  for (const std::string& file : scenario.behavior_files) found.add_file(file);
  behaviors::physics_check(world)(*scenario.behavior, found);
  for (core::Diagnostic item : found.sorted()) {
    if (item.mark.file >= 0) item.mark.file = diagnostics.add_file(found.file(item.mark.file));
    diagnostics.add(item);
  }
  if (!diagnostics.has_errors()) lab::check_edits(scenario, world, diagnostics);
}

// File kinds by their first key. A file without a kind is checked as a behavior, which reports it.
struct Kind {
  const char* key;
  void (*check)(const std::string& path, Checked& checked);
};
void check_sweep(const std::string& path, Checked& checked) {
  check_sweep_file(path, checked.diagnostics);
}
constexpr Kind kKinds[] = {
    {"behavior", check_behavior}, {"robot", check_robot}, {"world", check_world},
    {"scenario", check_scenario}, {"sweep", check_sweep},
};

void check_file(const std::string& file, const CheckOptions& options, Checked& checked) {
  core::Diagnostics& diagnostics = checked.diagnostics;
  if (file == "-") {
    const std::string text = core::read_whole_file(file);
    check_behavior_with(checked, [&](const behaviors::LoadOptions& load) {
      return behaviors::load_behavior_text(text, options.stdin_name, load, diagnostics);
    });
    return;
  }
  const std::string path = require_named_file(file, diagnostics);
  if (path.empty()) return;
  const std::string key = lab::first_key(path, base_folders());
  const auto kind = std::ranges::find_if(kKinds, [&](const Kind& k) { return key == k.key; });
  const bool takes_robot =
      kind == std::end(kKinds) || kind->check == check_behavior || kind->check == check_world;
  if (!options.robot.empty() && !takes_robot) {
    diagnostics.error({diagnostics.add_file("--robot"), 0, 0}, "set",
                      fmt::format("is of behaviors and worlds; '{}' is a {}", file, key));
    return;
  }
  const bool takes_world = kind == std::end(kKinds) || kind->check == check_behavior;
  if (!options.world.empty() && !takes_world) {
    diagnostics.error({diagnostics.add_file("--world"), 0, 0}, "set",
                      fmt::format("is of behaviors; '{}' is a {}", file, key));
    return;
  }
  (kind == std::end(kKinds) ? check_behavior : kind->check)(path, checked);
}

nlohmann::ordered_json to_json(const std::string& name, const Checked& checked, bool ok) {
  const core::Diagnostics& diagnostics = checked.diagnostics;
  auto list = nlohmann::ordered_json::array();
  for (const core::Diagnostic& item : diagnostics.sorted()) {
    list.push_back({{"severity", item.severity == core::Severity::error ? "error" : "warning"},
                    {"id", item.id},
                    {"file", item.mark.file >= 0 ? diagnostics.file(item.mark.file) : name},
                    {"line", item.mark.line},
                    {"column", item.mark.column},
                    {"text", item.text}});
  }
  return {{"file", name},
          {"ok", ok},
          {"not_judged", checked.not_judged},
          {"diagnostics", std::move(list)}};
}

std::string counted(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

int check(const CheckOptions& options) {
  int exit_code = kGood, errors = 0, warnings = 0;
  auto results = nlohmann::ordered_json::array();
  for (const std::string& file : options.files) {
    core::Diagnostics diagnostics;
    Checked checked{options.robot, options.world, diagnostics, {}};
    check_file(file, options, checked);
    const auto items = diagnostics.sorted();
    const auto wrong = static_cast<int>(
        std::ranges::count(items, core::Severity::error, &core::Diagnostic::severity));
    const int doubtful = static_cast<int>(items.size()) - wrong;
    errors += wrong;
    warnings += doubtful;
    const bool ok = wrong == 0 && (doubtful == 0 || !options.strict);
    if (wrong > 0) exit_code = kBadInput;
    if (!ok) exit_code = std::max(exit_code, kRobotFailed);
    const std::string name = file == "-" ? options.stdin_name : file;
    if (options.json) {
      results.push_back(to_json(name, checked, ok));
      continue;
    }
    print_diagnostics(diagnostics);
    if (!ok) continue;
    const std::string rest =
        checked.not_judged.empty() ? "" : "; --robot NAME judges its " + checked.not_judged;
    fmt::print("{}: ok{}{}\n", name, doubtful > 0 ? " (" + counted(doubtful, "warning") + ")" : "",
               rest);
  }
  if (options.json) {
    const nlohmann::ordered_json out = {{"files", std::move(results)}};
    // Invalid UTF-8 in a file is replaced instead of raising an exception.
    fmt::print("{}\n", core::json_text(out));
  } else if (options.files.size() > 1 || errors + warnings > 0) {
    fmt::print("{} checked: {}, {}\n", counted(static_cast<int>(options.files.size()), "file"),
               counted(errors, "error"), counted(warnings, "warning"));
  }
  return exit_code;
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand(
      "check", "Checks behavior, robot, world, scenario and sweep files without running them");
  command
      ->add_option("FILE", options->files,
                   "Behavior, world and robot files or names, scenario and sweep files; - for a "
                   "behavior on stdin")
      ->required();
  command->add_flag("--strict", options->strict, "Exit 1 if there are warnings");
  command->add_flag("--json", options->json, "One JSON object with every problem");
  command->add_option("--robot", options->robot,
                      "Robot file or name: of behaviors instead of their own, and to judge worlds");
  command->add_option("--world", options->world,
                      "World file or name in which behaviors are judged: its friction, terrain, "
                      "actuators and delays");
  auto* name = command->add_option(
      "--stdin-name", options->stdin_name,
      "File name for - in messages; `base:` and `robot:` are searched beside it");
  command->footer(
      "Exit codes: 0 clean, 1 warnings with --strict, 2 errors.\n"
      "Example: footfall check --strict behaviors/library/balance.yaml robots/hume/robot.yaml");
  command->callback([options, name, &exit_code] {
    const auto work = [&] {
      if (name->count() > 0 && std::ranges::find(options->files, "-") == options->files.end()) {
        throw InputError("--stdin-name: error: it is of `-`, which is not among the files");
      }
      return check(*options);
    };
    exit_code = guarded(work, kMachineFailed);
  });
}

}  // namespace footfall::apps
