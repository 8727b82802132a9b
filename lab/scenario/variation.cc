// What a scenario says of the draws; see variation.h.
#include "lab/scenario/variation.h"

#include <fmt/format.h>

#include <algorithm>

#include "lab/scenario/context.h"

namespace footfall::lab {
namespace {

using core::YamlNode;

void warn_if_late(const model::PushSpread& push, double duration, core::Mark mark,
                  core::Diagnostics& diagnostics) {
  const double first = push.between[0];
  if (push.impulse <= 0.0 || duration <= 0.0 || first < duration) return;
  diagnostics.warning(
      mark, "late-push",
      fmt::format("no push is drawn before {:g} s, and the run ends at {:g} s", first, duration));
}

const YamlNode* own_push(const ScenarioDescription& scenario) {
  return scenario.variation ? scenario.variation->find("push") : nullptr;
}

// A value, a distribution and a push go over the world's as a whole.
bool replaces_all(const YamlNode& node) {
  return !node.is_map() || node.find("sd") != nullptr || node.find("range") != nullptr ||
         node.find("impulse") != nullptr;
}

}  // namespace

void load_variation(ScenarioContext& context, const YamlNode& node) {
  ScenarioDescription& scenario = context.scenario;
  const int before = context.diagnostics.error_count();
  const model::Variation own = model::read_variation(node, {}, context.diagnostics);
  scenario.variation = node;
  if (context.bodies) model::check_links(own.links, *context.bodies, context.diagnostics);
  const YamlNode* const push = own_push(scenario);
  const YamlNode* const between = push == nullptr ? nullptr : push->find("between");
  if (between == nullptr || context.diagnostics.error_count() > before) return;
  warn_if_late(own.push, scenario.duration, between->mark, context.diagnostics);
}

model::Variation variation_over(const ScenarioDescription& scenario,
                                const model::Variation& world) {
  if (!scenario.variation) return world;
  core::Diagnostics known;  // the loader has told; its files are those of the positions
  for (const std::string& file : scenario.files) known.add_file(file);
  return model::read_variation(*scenario.variation, world, known);
}

void warn_late_push(const ScenarioDescription& scenario, const model::Variation& drawn,
                    core::Diagnostics& diagnostics) {
  if (own_push(scenario) != nullptr) return;
  warn_if_late(drawn.push, scenario.duration, scenario.duration_mark, diagnostics);
}

bool draws_random(const std::vector<behaviors::ScriptFile>& scripts) {
  return std::ranges::any_of(scripts, [](const behaviors::ScriptFile& script) {
    return script.text.find("random") != std::string::npos;
  });
}

bool seeds_alike(const ScenarioDescription& scenario, const model::Variation& drawn) {
  return !scenario.scripts_draw && !drawn.depends_on_seed();
}

std::string alike_seeds_text(std::size_t seeds, const std::string& world) {
  return fmt::format(
      "{} seeds are one run {} times: in world '{}' a seed draws nothing, and no "
      "script does",
      seeds, seeds, world);
}

void warn_alike_seeds(const ScenarioDescription& scenario, const model::Variation& drawn,
                      core::Diagnostics& diagnostics) {
  if (scenario.seeds.size() < 2 || !seeds_alike(scenario, drawn)) return;
  diagnostics.warning(scenario.seeds_mark, "alike-seeds",
                      alike_seeds_text(scenario.seeds.size(), scenario.world));
}

bool draws_itself(const ScenarioDescription& scenario, const std::vector<std::string>& path) {
  if (!scenario.variation) return false;
  const YamlNode* node = &*scenario.variation;
  for (const std::string& key : path) {
    if (replaces_all(*node)) return true;
    node = node->find(key);
    if (node == nullptr) return false;
  }
  return replaces_all(*node);
}

}  // namespace footfall::lab
