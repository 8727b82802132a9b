// Whether the seeds of a suite or sweep draw anything; see alike_seeds.h.
#include "apps/suites/alike_seeds.h"

#include <algorithm>

#include "apps/shared/commands.h"
#include "apps/suites/sweep_setup.h"
#include "behaviors/loader.h"
#include "lab/scenario/loader.h"
#include "lab/scenario/variation.h"
#include "lab/sweep/plan/derived_files.h"
#include "sim/world/description.h"

namespace footfall::apps {
namespace {

// The draws in a world; nullopt: the world cannot be loaded, which its own check reports.
std::optional<model::Variation> drawn_in(const std::string& world,
                                         const lab::ScenarioDescription& scenario) {
  core::Diagnostics ignored;
  const sim::WorldDescription description = sim::load_world(world, ignored);
  if (world.empty() || ignored.has_errors()) return std::nullopt;
  return lab::variation_over(scenario, description.variation);
}

// An axis of the world or the scenario may bring a draw of its own.
bool may_vary_draws(const lab::SweepAxis& axis) {
  return lab::is_world_axis(axis.name) || axis.name.starts_with("variation");
}

}  // namespace

void warn_alike_seeds(const std::vector<lab::SuiteScenario>& scenarios,
                      core::Diagnostics& diagnostics) {
  for (const lab::SuiteScenario& scenario : scenarios) {
    if (scenario.source == nullptr || scenario.seeds.size() < 2) continue;
    const lab::ScenarioDescription& source = *scenario.source;
    const auto drawn = drawn_in(find_world(source.world_from, source.world), source);
    if (!drawn || !lab::seeds_alike(source, *drawn)) continue;
    core::Mark mark = source.seeds_mark;
    mark.file = diagnostics.add_file(
        mark.file < 0 ? scenario.path : source.files[static_cast<std::size_t>(mark.file)]);
    diagnostics.warning(mark, "alike-seeds",
                        lab::alike_seeds_text(scenario.seeds.size(), source.world));
  }
}

void warn_alike_seeds(const lab::SweepDescription& sweep, const std::vector<std::string>& worlds,
                      core::Diagnostics& diagnostics) {
  if (sweep.seeds.size() < 2 || std::ranges::any_of(sweep.axes, may_vary_draws)) return;
  core::Diagnostics ignored;
  lab::ScenarioDescription scenario;
  if (sweep.scenario.empty()) {
    behaviors::LoadOptions load;
    load.search = search_path();
    load.robot = sweep.robot;
    scenario.behavior = behaviors::load_behavior(sweep.behavior, load, ignored);
  } else {
    scenario = lab::load_scenario(sweep.scenario, {search_path(), {}}, ignored);
  }
  if (ignored.has_errors()) return;
  scenario.scripts_draw |=
      scenario.behavior != nullptr && lab::draws_random(scenario.behavior->scripts);
  std::vector<std::string> names = sweep.worlds, paths = worlds;
  if (names.empty()) {
    names = {scenario.world};
    paths = {find_world(scenario.world_from, scenario.world)};
  }
  for (std::size_t w = 0; w < names.size(); ++w) {
    const auto drawn = drawn_in(paths[w], scenario);
    if (!drawn || !lab::seeds_alike(scenario, *drawn)) continue;
    diagnostics.warning(sweep.seeds_mark, "alike-seeds",
                        lab::alike_seeds_text(sweep.seeds.size(), names[w]));
  }
}

}  // namespace footfall::apps
