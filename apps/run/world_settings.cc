// Settings of a run's world; see world_settings.h.
#include "apps/run/world_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/shared/commands.h"
#include "core/text/dotted_name.h"
#include "lab/scenario/variation.h"

namespace footfall::apps {
namespace {

constexpr std::string_view kWorld = "world.";

[[noreturn]] void refuse(const std::string& key, const std::string& why) {
  throw InputError(fmt::format("--set world.{}: error: {}", key, why));
}

bool is_at_or_below(std::string_view key, std::string_view above) {
  return key == above ||
         (key.starts_with(above) && key.size() > above.size() && key[above.size()] == '.');
}

// What a stand has of a world.
bool acts_on_the_stub(const std::string& key) {
  constexpr std::array<std::string_view, 8> kUsed = {"actuators",
                                                     "stand",
                                                     "sensors",
                                                     "control_model",
                                                     "planner_latency",
                                                     "variation.actuators",
                                                     "variation.command_delay",
                                                     "variation.start"};
  return key == "variation" ||
         std::ranges::any_of(kUsed, [&](auto used) { return is_at_or_below(key, used); });
}

void check_key(const RunOptions& options, const std::string& key) {
  const std::string first = core::split_dots(key).front();
  if (first == "base" || first == "world" || first == "name" || first == "doc") {
    refuse(key, "a setting is a value of the world, not another world: give that to --world");
  }
  if (options.backend == "stub" && !acts_on_the_stub(key)) {
    refuse(key, "no effect on the backend stub, which has no physics");
  }
  if (options.backend == "mujoco" && first == "stand") {
    refuse(key, "no effect on the backend mujoco: it is of `--backend stub`");
  }
  if (options.variation == "off" && first == "variation") {
    refuse(key, "no effect beside `--variation off`");
  }
}

}  // namespace

void separate_world_settings(RunOptions& options) {
  std::vector<std::string> others;
  for (const std::string& text : options.set) {
    if (!text.starts_with(kWorld)) {
      others.push_back(text);
      continue;
    }
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size() || equals == kWorld.size()) {
      throw InputError("--set " + text + ": error: expected NAME=VALUE");
    }
    const std::string key = text.substr(kWorld.size(), equals - kWorld.size());
    check_key(options, key);
    for (const auto& [other, value] : options.world_set) {
      if (is_at_or_below(key, other) || is_at_or_below(other, key)) {
        refuse(key, other == key ? "set twice" : "'world." + other + "' is set as well");
      }
    }
    options.world_set.emplace_back(key, text.substr(equals + 1));
  }
  options.set = std::move(others);
}

void refuse_shadowed_settings(const RunOptions& options, const lab::ScenarioDescription& scenario) {
  for (const auto& [key, value] : options.world_set) {
    std::vector<std::string> path =
        core::split_dots(key == "ground.friction" ? "variation.friction" : key);
    if (path.front() != "variation") continue;
    path.erase(path.begin());
    if (lab::draws_itself(scenario, path)) {
      refuse(key, "no effect: the scenario's own `variation:` goes over it");
    }
  }
}

sim::WorldSettings world_settings(const RunOptions& options, bool world_given) {
  sim::WorldSettings settings = options.world_set;
  const bool model_given = std::ranges::any_of(settings, [](const auto& setting) {
    return setting.first == "actuators.model" || setting.first == "actuators";
  });
  if (options.backend == "stub" && !world_given && !model_given) {
    settings.insert(settings.begin(), {"actuators.model", "series_elastic"});
  }
  return settings;
}

std::string world_settings_text(const RunOptions& options) {
  std::string text;
  for (const auto& [key, value] : options.world_set) text += fmt::format(" {}={}", key, value);
  return text;
}

}  // namespace footfall::apps
