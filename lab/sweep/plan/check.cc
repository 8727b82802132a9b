// Checks a sweep by loading samples of what its runs would load; see check.h.
#include "lab/sweep/plan/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "behaviors/loader.h"
#include "core/process/temporary_folder.h"
#include "core/text/dotted_name.h"
#include "lab/scenario/loader.h"
#include "lab/scenario/variation.h"
#include "lab/sweep/plan/derived_files.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;
using core::Diagnostics;

constexpr std::size_t kMostTries = 200;  // loads of the behavior, about 10 ms each

void take_errors(const Diagnostics& from, Diagnostics& to) {
  for (core::Diagnostic item : from.sorted()) {
    if (item.severity != core::Severity::error) continue;
    if (item.mark.file >= 0) item.mark.file = to.add_file(from.file(item.mark.file));
    to.error(item.mark, item.id, item.text);
  }
}

void list_files(const Diagnostics& from, std::vector<std::string>& files) {
  for (int k = 0; k < from.file_count(); ++k) {
    std::error_code ignored;
    if (fs::is_regular_file(from.file(k), ignored)) files.push_back(from.file(k));
  }
}

// Errors that the behavior has in this world and not in the default one: no run of the sweep could
// start there.
void check_in_world(const behaviors::Behavior& behavior, const std::vector<std::string>& files,
                    const behaviors::PhysicsWorld& world, Diagnostics& diagnostics) {
  Diagnostics usual, found;
  for (const std::string& file : files) {
    usual.add_file(file);
    found.add_file(file);
  }
  behaviors::check_physics(behavior, usual);
  if (usual.has_errors()) return;  // left to the runs, which may vary what is wrong
  behaviors::check_physics(behavior, found, world);
  take_errors(found, diagnostics);
}

// The behavior once more, with the actuators that its robot has in a world.
std::unique_ptr<behaviors::Behavior> base_behavior(
    const SweepDescription& sweep, const SweepCheckOptions& options,
    const std::function<void(model::RobotDescription&, Diagnostics&)>& world) {
  Diagnostics told;  // without them, and by the world's check
  if (!sweep.scenario.empty()) {
    return std::move(load_scenario(sweep.scenario, {options.search, {}, world}, told).behavior);
  }
  behaviors::LoadOptions load;
  load.search = options.search;
  load.robot = sweep.robot;
  load.world = world;
  return behaviors::load_behavior(sweep.behavior, load, told);
}

// Checks the behavior or scenario itself, and takes the settings that the sweep leaves to it.
void check_base(SweepDescription& sweep, const SweepCheckOptions& options, Diagnostics& diagnostics,
                std::vector<std::string>& files) {
  Diagnostics found;
  std::string model;
  std::unique_ptr<behaviors::Behavior> behavior;
  std::vector<std::string> behavior_files;
  ScenarioDescription scenario;  // without one its `variation` is empty
  if (sweep.scenario.empty()) {
    behaviors::LoadOptions load;
    load.search = options.search;
    load.robot = sweep.robot;
    behavior = behaviors::load_behavior(sweep.behavior, load, found);
    if (behavior != nullptr && !behavior->has_robot) {
      found.error({found.add_file(sweep.behavior), 0, 0}, "missing-key",
                  "a behavior without `robot:` cannot be run");
    }
    if (behavior != nullptr) model = behavior->robot.model_path;
    for (int k = 0; k < found.file_count(); ++k) behavior_files.push_back(found.file(k));
  } else {
    scenario = load_scenario(sweep.scenario, {options.search, {}}, found);
    if (sweep.seeds.empty()) sweep.seeds = scenario.seeds;
    if (sweep.duration.empty()) sweep.duration_s = scenario.duration;
    behavior = std::move(scenario.behavior);
    if (behavior != nullptr) model = behavior->robot.model_path;
    behavior_files = scenario.behavior_files;
    files.insert(files.end(), scenario.behavior_files.begin(), scenario.behavior_files.end());
  }
  take_errors(found, diagnostics);
  list_files(found, files);
  if (!model.empty()) files.push_back(model);
  for (std::size_t w = 0; w < options.worlds.size(); ++w) {
    Diagnostics world;
    const behaviors::PhysicsWorld physics =
        options.check_world(options.worlds[w], scenario, behavior.get(), world);
    take_errors(world, diagnostics);
    list_files(world, files);
    const bool good = behavior != nullptr && behavior->has_robot && !diagnostics.has_errors();
    if (good && physics.actuators) {
      const auto there = base_behavior(sweep, options, physics.actuators);
      if (there != nullptr) check_in_world(*there, behavior_files, physics, diagnostics);
    } else if (good) {
      check_in_world(*behavior, behavior_files, physics, diagnostics);
    }
  }
}

// Indices of the axis values that are tried.
std::vector<std::size_t> candidates(const SweepAxis& axis) {
  std::vector<std::size_t> list;
  if (axis.spelled) {
    for (std::size_t k = 0; k < axis.values.size() && k < kMostTries; ++k) list.push_back(k);
    return list;
  }
  const auto less = [](const SweepValue& a, const SweepValue& b) { return a.number < b.number; };
  const auto [low, high] = std::minmax_element(axis.values.begin(), axis.values.end(), less);
  return {static_cast<std::size_t>(low - axis.values.begin()),
          static_cast<std::size_t>(high - axis.values.begin())};
}

// Reports problems found by a trial load at the sweep value that caused them.
class Blame {
 public:
  Blame(const SweepDescription& sweep, const SweepRun& run, const SweepTarget& target,
        Diagnostics& diagnostics)
      : sweep_(sweep), run_(run), target_(target), diagnostics_(diagnostics) {}

  void take(const Diagnostics& found) {
    for (const core::Diagnostic& item : found.sorted()) {
      const std::string file = item.mark.file >= 0 ? found.file(item.mark.file) : "";
      if (item.severity != core::Severity::error) {
        refuse_idle(item, file);
        continue;
      }
      std::string text = item.text;
      for (std::size_t a = 0; a < sweep_.axes.size(); ++a) {
        const std::string said = "--set " + sweep_.axes[a].name;
        if (file != said && !text.starts_with(said + ": ")) continue;
        if (text.starts_with(said + ": ")) text.erase(0, said.size() + 2);
        diagnostics_.error(mark(a), item.id, text);
        text.clear();
        break;
      }
      if (!text.empty()) elsewhere(item, file, text);
    }
  }

  core::Mark mark(std::size_t axis) const {
    return sweep_.axes[axis].values[run_.values[axis]].mark;
  }

 private:
  // Refuses an axis whose values change nothing; its warning would be lost among the runs.
  void refuse_idle(const core::Diagnostic& item, const std::string& file) {
    for (const SweepAxis& axis : sweep_.axes) {
      const std::string said = fmt::format("--set {} changes nothing", axis.name);
      if (!item.text.starts_with(said)) continue;
      const std::string text = item.text.substr(std::string_view("--set ").size());
      diagnostics_.error(
          axis.mark, "unknown-setting",
          fmt::format("{} ({}:{}:{})", text, file, item.mark.line, item.mark.column));
    }
  }
  // Reports an error in a derived file, or at the place where a value is used.
  void elsewhere(const core::Diagnostic& item, const std::string& file, const std::string& text) {
    const bool world = file == target_.world, script = file == target_.path;
    std::optional<core::Mark> place;
    for (std::size_t a = 0; a < sweep_.axes.size() && !place; ++a) {
      const std::string& name = sweep_.axes[a].name;
      if (is_world_axis(name) != world || is_scenario_axis(name) != script) continue;
      place = mark(a);
    }
    std::string with;
    for (const auto& [name, value] : settings_of(sweep_, run_)) {
      with += fmt::format("{}{} = {}", with.empty() ? "" : ", ", name, value);
    }
    if (!sweep_.faults[run_.fault].fault.empty()) {
      with += (with.empty() ? "" : ", ") + sweep_.faults[run_.fault].label;
    }
    const std::string where =
        world || script || file.empty() ? "" : fmt::format("{}:{}: ", file, item.mark.line);
    diagnostics_.error(place.value_or(core::Mark{}), item.id,
                       fmt::format("{}{} (with {})", where, text, with));
  }

  const SweepDescription& sweep_;
  const SweepRun& run_;
  const SweepTarget& target_;
  Diagnostics& diagnostics_;
};

// Values of the world's draws do nothing where the scenario draws the same over them.
void refuse_shadowed(const SweepDescription& sweep, const ScenarioDescription& scenario,
                     Diagnostics& diagnostics) {
  for (const SweepAxis& axis : sweep.axes) {
    if (!is_world_axis(axis.name)) continue;
    const bool ground = axis.name == "world.ground.friction";
    const std::string own =
        ground ? "variation.friction" : axis.name.substr(std::string_view("world.").size());
    std::vector<std::string> path = core::split_dots(own);
    if (path.front() != "variation") continue;
    path.erase(path.begin());
    if (!draws_itself(scenario, path)) continue;
    // With `friction: off` the ground's own is what a run has.
    if (ground && variation_over(scenario, {}).friction.kind == model::Spread::Kind::none) continue;
    diagnostics.error(axis.mark, "unknown-setting",
                      fmt::format("'{}' has no effect: the scenario's `variation:` goes over it; "
                                  "vary '{}'",
                                  axis.name, own));
  }
}

void try_run(const SweepDescription& sweep, const SweepRun& run, SweepFiles& files,
             const SweepCheckOptions& options, Diagnostics& diagnostics) {
  SweepTarget target;
  try {
    target = files.target(run);
  } catch (const std::runtime_error& error) {
    std::string text = error.what();
    core::Mark mark;
    for (const SweepAxis& axis : sweep.axes) {
      if (text.starts_with(axis.name + ": ")) mark = axis.mark;
    }
    diagnostics.error(mark, "unknown-setting", text);
    return;
  }
  Blame blame(sweep, run, target, diagnostics);
  Diagnostics found;
  ScenarioDescription scenario;
  std::unique_ptr<behaviors::Behavior> behavior;
  if (target.scenario) {
    scenario = load_scenario(target.path, {options.search, target.set}, found);
    behavior = std::move(scenario.behavior);
  } else {
    behaviors::LoadOptions load;
    load.search = options.search;
    load.robot = sweep.robot;
    load.set = target.set;
    behavior = behaviors::load_behavior(target.path, load, found);
  }
  blame.take(found);
  if (target.world.empty()) return;
  refuse_shadowed(sweep, scenario, diagnostics);
  Diagnostics world;
  options.check_world(target.world, scenario, behavior.get(), world);
  blame.take(world);
}

// Tries rows, each a run with one candidate per axis, so that every candidate occurs in some row.
void try_values(const SweepDescription& sweep, const SweepCheckOptions& options,
                Diagnostics& diagnostics) {
  std::vector<std::vector<std::size_t>> tried;
  std::size_t rows = std::max<std::size_t>(sweep.faults.size(), 1);
  for (const SweepAxis& axis : sweep.axes) {
    tried.push_back(candidates(axis));
    rows = std::max(rows, tried.back().size());
  }
  const core::TemporaryFolder folder;
  SweepFiles files(sweep, folder.path(), options.worlds);
  for (std::size_t row = 0; row < rows; ++row) {
    SweepRun run;
    for (const auto& list : tried) run.values.push_back(list[std::min(row, list.size() - 1)]);
    run.fault = std::min(row, sweep.faults.size() - 1);
    run.seed = sweep.seeds.front();
    try_run(sweep, run, files, options, diagnostics);
  }
}

void check_script_axes(const SweepDescription& sweep, Diagnostics& diagnostics) {
  for (const SweepAxis& axis : sweep.axes) {
    if (is_script_axis(axis.name) && sweep.scenario.empty()) {
      diagnostics.error(
          axis.mark, "unknown-setting",
          fmt::format("'{}' needs a scenario: a behavior has no script of the run", axis.name));
    }
  }
}

}  // namespace

std::vector<std::string> check_sweep(SweepDescription& sweep, const SweepCheckOptions& options,
                                     Diagnostics& diagnostics) {
  std::vector<std::string> files;
  if (diagnostics.has_errors()) return files;
  check_script_axes(sweep, diagnostics);
  check_base(sweep, options, diagnostics, files);
  if (sweep.seeds.empty()) sweep.seeds = {1};
  if (!diagnostics.has_errors()) try_values(sweep, options, diagnostics);
  if (diagnostics.has_errors()) return {};
  std::ranges::sort(files);
  const auto rest = std::ranges::unique(files);
  files.erase(rest.begin(), rest.end());
  return files;
}

}  // namespace footfall::lab
