// Loads and checks a sweep; see sweep_setup.h.
#include "apps/suites/sweep_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/shared/commands.h"
#include "apps/suites/alike_seeds.h"
#include "core/text/whole_file.h"
#include "lab/scenario/loader.h"
#include "lab/scenario/variation.h"
#include "lab/sweep/plan/check.h"
#include "lab/sweep/plan/derived_files.h"
#include "sim/world/description.h"

namespace footfall::apps {
namespace {

behaviors::PhysicsWorld load_and_check_world(const std::string& path,
                                             const lab::ScenarioDescription& scenario,
                                             const behaviors::Behavior* behavior,
                                             core::Diagnostics& diagnostics) {
  sim::WorldDescription world = sim::load_world(path, diagnostics, search_path());
  world.variation = lab::variation_over(scenario, world.variation);
  if (!diagnostics.has_errors()) sim::check_supported(world, diagnostics);
  const bool complete = !diagnostics.has_errors() && behavior != nullptr && behavior->has_robot;
  if (complete) check_world_fits(world, behavior->robot, diagnostics, lab::holds_of(scenario));
  return physics_world(world, !lab::holds_of(scenario).empty());
}

// Varied parameters of the world need a file as `base:`, so name the default world.
void name_default_world(lab::SweepDescription& sweep, core::Diagnostics& diagnostics) {
  const bool needed = std::ranges::any_of(
      sweep.axes, [](const lab::SweepAxis& axis) { return lab::is_world_axis(axis.name); });
  if (!needed || !sweep.worlds.empty()) return;
  sweep.worlds = {"flat"};
  sweep.world_marks = {core::Mark{}};
  if (sweep.scenario.empty()) return;
  const auto scenario = lab::load_scenario(sweep.scenario, {search_path()}, diagnostics);
  if (!scenario.world.empty()) sweep.worlds = {find_world(scenario.world_from, scenario.world)};
}

// A scenario's own world is loaded by its runs: whether they can is told before the first of them.
void check_scenario_world(const lab::SweepDescription& sweep, core::Diagnostics& diagnostics) {
  if (diagnostics.has_errors() || sweep.scenario.empty() || !sweep.worlds.empty()) return;
  const auto scenario = lab::load_scenario(sweep.scenario, {search_path()}, diagnostics);
  const std::string path = find_world(scenario.world_from, scenario.world);
  if (!path.empty()) load_and_check_world(path, scenario, scenario.behavior.get(), diagnostics);
}

}  // namespace

std::string find_world(const std::string& beside, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(beside).parent_path();
  const std::string path = sim::find_world_file((folder / name).string(), {});
  return path.empty() ? sim::find_world_file(name, search_path()) : path;
}

PreparedSweep prepare_sweep(lab::SweepDescription sweep, core::Diagnostics& diagnostics) {
  PreparedSweep prepared;
  if (!diagnostics.has_errors()) name_default_world(sweep, diagnostics);
  for (std::size_t w = 0; w < sweep.worlds.size(); ++w) {
    prepared.worlds.push_back(find_world(sweep.path, sweep.worlds[w]));
    if (!prepared.worlds.back().empty()) continue;
    diagnostics.error(
        sweep.world_marks[w], "cannot-read",
        fmt::format("unknown world '{}': no such file here, and no "
                    "sim/worlds/{}.yaml in {}",
                    sweep.worlds[w], sweep.worlds[w], fmt::join(search_path(), ", ")));
  }
  const lab::SweepCheckOptions options = {search_path(), prepared.worlds, load_and_check_world};
  prepared.inputs = lab::check_sweep(sweep, options, diagnostics);
  check_scenario_world(sweep, diagnostics);
  if (!diagnostics.has_errors()) warn_alike_seeds(sweep, prepared.worlds, diagnostics);
  prepared.sweep = std::move(sweep);
  return prepared;
}

void check_sweep_file(const std::string& path, core::Diagnostics& diagnostics) {
  prepare_sweep(lab::load_sweep(path, {search_path()}, diagnostics), diagnostics);
}

std::string digest_of_files(const std::vector<std::string>& paths) {
  std::string all;
  for (const std::string& path : paths) all += lab::digest(core::read_whole_file(path));
  return lab::digest(all);
}

}  // namespace footfall::apps
