// Worlds as a whole: what can be simulated of them, what a seed makes of them, where they are; see
// description.h.
#include "sim/world/description.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/text/search_folders.h"
#include "core/yaml/layers.h"
#include "core/yaml/value_reader.h"

namespace footfall::sim {

using core::Diagnostics;

void check_supported(const WorldDescription& world, Diagnostics& diagnostics) {
  for (const ActuatorSettings::Key& key : world.actuators.elastic_keys) {
    if (world.actuators.model == ActuatorModel::series_elastic) break;
    // `ideal` on top of a base's elastic actuators takes their imperfections away, too.
    if (world.actuators.mark.file != key.mark.file) continue;
    diagnostics.error(key.mark, "unsupported",
                      fmt::format("'{}' has no effect on ideal actuators: expected 'model: "
                                  "series_elastic' beside it",
                                  key.name));
  }
}

void check_links(const WorldDescription& world, const std::vector<std::string>& bodies,
                 Diagnostics& diagnostics) {
  model::check_links(world.links, bodies, diagnostics);
  model::check_links(world.variation.links, bodies, diagnostics);
}

std::optional<double> read_tilt(const core::YamlNode& node, Diagnostics& diagnostics) {
  constexpr double kMost = 0.5;  // rad
  return core::read_bounded(node, core::kNone, -kMost, kMost, diagnostics,
                            "an angle within 0.5 rad");
}

std::optional<double> read_turn(const core::YamlNode& node, Diagnostics& diagnostics) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return core::read_bounded(node, core::kNone, -kTurn, kTurn, diagnostics, "an angle");
}

std::vector<double> axis_tilts(const WorldDescription& world, const model::RobotDescription& robot,
                               Diagnostics& diagnostics) {
  return by_joint(world.axis_tilts, read_tilt, robot, diagnostics);
}

std::vector<double> start_joints(const ByJoint& given, const model::RobotDescription& robot,
                                 Diagnostics& diagnostics) {
  return by_joint(given, read_turn, robot, diagnostics);
}

void check_actuators(const WorldDescription& world, const model::RobotDescription& robot,
                     Diagnostics& diagnostics) {
  check_actuators(world.actuators, robot, world.physics.steps_per_tick, diagnostics);
  axis_tilts(world, robot, diagnostics);
  start_joints(world.start_joints, robot, diagnostics);
  if (world.actuators.model != ActuatorModel::ideal || !world.variation.draws_actuators()) return;
  // `ideal` on top of a base's elastic actuators takes their draws away, too.
  if (world.actuators.file != world.variation.actuators.file) return;
  core::Mark mark = world.variation.actuators.mark;
  mark.file = diagnostics.add_file(world.variation.actuators.file);
  diagnostics.error(mark, "actuators",
                    "the world's actuators are ideal, without springs and friction: expected "
                    "'actuators: {model: series_elastic}' in it, or none of these draws");
}

WorldDescription with_draw(WorldDescription world, const model::Draw& drawn) {
  world.start = {drawn.joints, drawn.velocity, drawn.rates};
  world.friction = drawn.friction.value_or(world.friction);
  world.noise_seed = drawn.seed;
  world.control_model.mass_scale *= drawn.mass.value_or(1.0);
  world.control_model.mass_scales = drawn.masses;
  for (const auto& [link, shift] : drawn.com) {
    for (std::size_t k = 0; k < shift.size(); ++k) {
      world.control_model.com_shift[link][k] += shift[k];
    }
  }
  std::vector<model::TerrainPiece>& boxes = world.control_model.terrain.boxes;
  for (std::size_t b = 0; b < boxes.size() && b < drawn.terrain.size(); ++b) {
    boxes[b] = mistaken(boxes[b], drawn.terrain[b]);
  }
  world.actuators.command_delay += drawn.command_delay.value_or(0.0);
  world.actuators.drawn_springs = drawn.springs;
  world.actuators.drawn_coulomb = drawn.coulomb;
  return world;
}

std::string find_world_file(const std::string& name, const std::vector<std::string>& search) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (name.empty()) return {};
  if (core::is_readable_source(name)) return name;
  for (const std::string& folder : search) {
    const fs::path path = fs::path(folder) / "sim" / "worlds" / (name + ".yaml");
    if (fs::is_regular_file(path, error)) return path.string();
  }
  return {};
}

}  // namespace footfall::sim
