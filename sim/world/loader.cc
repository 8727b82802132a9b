// Reads a `world: 1` file into a WorldDescription; see description.h.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string_view>
#include <utility>

#include "core/text/dotted_name.h"
#include "core/text/search_folders.h"
#include "core/yaml/layers.h"
#include "core/yaml/value_reader.h"
#include "sim/world/description.h"
#include "sim/world/keys.h"

namespace footfall::sim {

namespace {

using core::Diagnostics;
using core::YamlEntry;
using core::YamlNode;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One function a section of the file; each reports its own problems and the next one goes on.
class WorldLoader {
 public:
  WorldLoader(const std::string& path, Diagnostics& diagnostics) : diagnostics_(diagnostics) {
    world_.path = path;
  }

  WorldDescription load(const YamlNode& root) {
    if (!core::check_kind(root, "world", 1, diagnostics_)) return std::move(world_);
    core::check_keys(root, kWorldKeys, diagnostics_);
    read_head(root);
    read_terrain(root);
    refuse_two_frictions(root);
    if (const YamlNode* node = root.find("surface")) read_surface(*node);
    if (const YamlNode* node = root.find("actuators")) {
      read_actuators(*node, world_.actuators, diagnostics_);
    }
    if (const YamlNode* node = root.find("sensors")) {
      read_sensors(*node, world_.sensors, diagnostics_);
    }
    if (const YamlNode* node = root.find("control_model")) read_control_model(*node);
    if (const YamlNode* node = root.find("axis_tilts")) {
      world_.axis_tilts = {*node, diagnostics_.file(node->mark.file)};
      check_by_joint(*node, read_tilt, "an angle by joint", diagnostics_);
    }
    if (const YamlNode* node = root.find("start")) read_start(*node);
    if (const YamlNode* node = root.find("constraints")) read_constraints(*node);
    if (const YamlNode* node = root.find("physics")) read_physics(*node);
    if (const YamlNode* node = root.find("stand")) read_stand(*node);
    world_.variation.noise = world_.sensors.errors.random() || world_.height_error > 0.0;
    return std::move(world_);
  }

 private:
  void read_head(const YamlNode& root) {
    world_.name = std::filesystem::path(world_.path).stem().string();
    if (const YamlNode* node = root.find("name")) {
      world_.name = core::read_name(*node, diagnostics_, "the world's name").value_or(world_.name);
    }
    if (const YamlNode* node = root.find("doc")) {
      world_.doc = core::read_text(*node, diagnostics_).value_or("");
    }
    if (const YamlNode* node = root.find("variation")) {
      world_.variation = model::read_variation(*node, {}, diagnostics_);
    }
    read_bounded(root, "planner_latency", core::kTime, 0.0, kInfinity, world_.planner_latency);
  }

  void read_bounded(const YamlNode& map, std::string_view key, core::Dimension dimension,
                    double minimum, double maximum, double& out, std::string_view what = {}) {
    const YamlNode* const node = map.find(key);
    if (node == nullptr) return;
    out = core::read_bounded(*node, dimension, minimum, maximum, diagnostics_, what).value_or(out);
  }

  void read_terrain(const YamlNode& root) {
    GroundSettings ground;
    if (const YamlNode* node = root.find("ground")) read_ground(*node, ground, diagnostics_);
    world_.friction = ground.friction;
    world_.height_error = ground.height_error;
    world_.terrain = std::move(ground.terrain);
    model::TerrainError& error = world_.variation.terrain;
    if (const YamlNode* node = root.find("terrain_belief")) {
      read_belief(*node, world_.belief, error, diagnostics_);
    }
    if (world_.belief == TerrainBelief::flat) return;
    world_.control_model.terrain = terrain_of(world_.terrain);
    error.boxes = static_cast<int>(world_.terrain.size());
  }

  // Of two files the one on top decides (model::prepare_variation); in one file nobody could tell.
  void refuse_two_frictions(const YamlNode& root) {
    const YamlNode* const ground = root.find("ground");
    const YamlNode* const value = ground == nullptr ? nullptr : ground->find("friction");
    if (value == nullptr || world_.variation.friction.kind == model::Spread::Kind::none) return;
    const YamlNode& drawn = *root.find("variation")->find("friction");
    if (drawn.mark.file != value->mark.file) return;
    diagnostics_.error(drawn.mark, "misplaced-key",
                       "'variation: {friction}' beside 'ground: {friction}': the draw would take "
                       "the place of the value; only one is allowed");
  }

  void read_surface(const YamlNode& node) {
    if (!core::expect_map(node, "{ramps: [{from: X, to: X, rise: Z}, ...]}", diagnostics_)) return;
    core::check_keys(node, kSurfaceKeys, diagnostics_);
    const YamlNode* const ramps = core::require_key(node, "ramps", diagnostics_);
    if (ramps == nullptr || !core::expect_sequence(*ramps, "a list of ramps", diagnostics_)) return;
    for (const YamlNode& item : ramps->items) {
      if (!core::expect_map(item, "a ramp: {from: X, to: X, rise: Z}", diagnostics_)) continue;
      core::check_keys(item, kRampKeys, diagnostics_);
      model::SurfaceRamp ramp;
      bool good = true;
      const auto read = [&](std::string_view key, double& out) {
        good = core::require_key(item, key, diagnostics_) != nullptr &&
               core::read_quantity(item, key, core::kLength, out, diagnostics_) && good;
      };
      read("from", ramp.from);
      read("to", ramp.to);
      read("rise", ramp.rise);
      if (good && ramp.to <= ramp.from) {
        diagnostics_.error(item.mark, "range", "expected 'from' before 'to' in a ramp");
      }
      world_.surface.ramps.push_back(ramp);
    }
  }

  void read_control_model(const YamlNode& node) {
    if (!core::expect_map(node, "{mass: \"+5 %\", com: {LINK: [X, Y, Z]}}", diagnostics_)) return;
    core::check_keys(node, kControlModelKeys, diagnostics_);
    if (const YamlNode* mass = node.find("mass")) read_mass(*mass);
    const YamlNode* const com = node.find("com");
    if (com == nullptr || !core::expect_map(*com, "a map by link", diagnostics_)) return;
    for (const YamlEntry& entry : com->entries) {
      const auto shift = core::read_vector3(entry.value, core::kLength, diagnostics_);
      if (shift) world_.control_model.com_shift[entry.key] = *shift;
      world_.links.push_back(model::named_link(entry, diagnostics_));
    }
  }

  void read_mass(const YamlNode& node) {
    constexpr double kMostLighter = -0.9;
    constexpr double kMostHeavier = 9.0;
    const auto change = core::read_bounded(node, core::kNone, kMostLighter, kMostHeavier,
                                           diagnostics_, "a change such as \"+5 %\"");
    if (!change) return;
    // "105 %" is ambiguous (a factor or a change): a change needs a sign.
    const std::size_t first = node.scalar.find_first_not_of(" \t");
    const bool has_sign = node.scalar[first] == '+' || node.scalar[first] == '-';
    if (!has_sign && *change != 0.0) {
      core::report_expected(node, "a change with its sign, such as \"+5 %\"", diagnostics_);
      return;
    }
    world_.control_model.mass_scale = 1.0 + *change;
  }

  void read_constraints(const YamlNode& node) {
    world_.constraints = model::read_constraints(node, diagnostics_);
    for (const model::BodySprings& aid : world_.constraints) {
      if (!aid.body.name.empty()) world_.links.push_back(aid.body);
      for (int axis = 0; aid.known && axis < 6; ++axis) {
        if (aid.axes[static_cast<std::size_t>(axis)]) {
          world_.control_model.held.push_back({aid.body.name, axis});
        }
      }
    }
  }

  void read_physics(const YamlNode& node) {
    if (!core::expect_map(node, "a map of physics settings", diagnostics_)) return;
    core::check_keys(node, kPhysicsKeys, diagnostics_);
    PhysicsSettings& physics = world_.physics;
    read_integer(node, "timestep_divisor", 1000, physics.steps_per_tick);
    read_choice(node, "integrator", kIntegrators, physics.integrator);
    read_choice(node, "solver", kSolvers, physics.solver);
    read_choice(node, "cone", kCones, physics.cone);
    read_bounded(node, "impratio", core::kNone, 1e-3, 1e6, physics.impratio);
    read_integer(node, "iterations", 100'000, physics.iterations);
    read_bounded(node, "tolerance", core::kNone, 0.0, 1.0, physics.tolerance);
    if (const YamlNode* solref = node.find("solref")) read_solref(*solref);
    if (const YamlNode* solimp = node.find("solimp")) read_solimp(*solimp);
    read_bounded(node, "hands", core::kRate, 1.0, 200.0, physics.hands);
  }

  void read_start(const YamlNode& node) {
    if (!core::expect_map(node, "a start: {joints: {JOINT: ANGLE}, height: VALUE}", diagnostics_)) {
      return;
    }
    core::check_keys(node, kStartKeys, diagnostics_);
    constexpr double kHighest = 10.0;  // m
    read_bounded(node, "height", core::kLength, 0.0, kHighest, world_.start_height, "a height");
    if (const YamlNode* joints = node.find("joints")) {
      world_.start_joints = {*joints, diagnostics_.file(joints->mark.file)};
      check_by_joint(*joints, read_turn, "an angle by joint", diagnostics_);
    }
  }

  void read_stand(const YamlNode& node) {
    if (!core::expect_map(node, "a map of what holds the joints", diagnostics_)) return;
    core::check_keys(node, kStandKeys, diagnostics_);
    StandSettings& stand = world_.stand;
    constexpr double kLeast = 1e-6;
    read_bounded(node, "inertia", core::kInertia, kLeast, kInfinity, stand.inertia);
    read_bounded(node, "stiffness", core::kTorque, 0.0, kInfinity, stand.stiffness, "a stiffness");
    read_bounded(node, "damping", core::kAngularMomentum, 0.0, kInfinity, stand.damping,
                 "a damping");
    read_bounded(node, "swing", core::kTime, 0.0, kInfinity, stand.swing);
  }

  void read_integer(const YamlNode& map, std::string_view key, int maximum, int& out) {
    const YamlNode* const node = map.find(key);
    if (node == nullptr) return;
    out = static_cast<int>(core::read_integer(*node, 1, maximum, diagnostics_).value_or(out));
  }

  template <typename Enum>
  void read_choice(const YamlNode& map, std::string_view key,
                   std::span<const core::WordSpec> choices, Enum& out) {
    const YamlNode* const node = map.find(key);
    if (node == nullptr) return;
    if (const auto choice = core::read_choice(*node, choices, diagnostics_)) {
      out = static_cast<Enum>(*choice);
    }
  }

  // The two values have different dimensions: a time constant and a ratio.
  void read_solref(const YamlNode& node) {
    if (!node.is_sequence() || node.items.size() != 2) {
      core::report_expected(node, "[TIME CONSTANT, DAMPING RATIO]", diagnostics_);
      return;
    }
    std::array<double, 2>& solref = world_.physics.solref;
    constexpr double kLeast = 1e-6;
    solref[0] = core::read_bounded(node.items[0], core::kTime, kLeast, 10.0, diagnostics_)
                    .value_or(solref[0]);
    solref[1] = core::read_bounded(node.items[1], core::kNone, kLeast, 100.0, diagnostics_)
                    .value_or(solref[1]);
  }

  void read_solimp(const YamlNode& node) {
    if (!node.is_sequence() || node.items.size() != 3) {
      core::report_expected(node, "[IMPEDANCE AT 0, IMPEDANCE AT WIDTH, WIDTH]", diagnostics_);
      return;
    }
    std::array<double, 3>& solimp = world_.physics.solimp;
    for (std::size_t i = 0; i < 2; ++i) {
      solimp[i] = core::read_bounded(node.items[i], core::kNone, 1e-4, 0.9999, diagnostics_)
                      .value_or(solimp[i]);
    }
    solimp[2] = core::read_bounded(node.items[2], core::kLength, 0.0, 1.0, diagnostics_)
                    .value_or(solimp[2]);
  }

  Diagnostics& diagnostics_;
  WorldDescription world_;
};

// A setting as a file that has nothing else, over the one that was read.
void lay_over(YamlNode& root, const std::string& key, const std::string& value,
              Diagnostics& problems) {
  if (root.is_null()) return;
  YamlNode own = core::load_yaml_text(value, "--set world." + key, problems);
  if (own.is_null()) return;  // told
  const core::Mark mark = own.mark;
  std::vector<std::string> parts = core::split_dots(key);
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    YamlNode map;
    map.kind = YamlNode::Kind::map;
    map.mark = mark;
    map.entries.push_back({*part, mark, false, std::move(own)});
    own = std::move(map);
  }
  model::prepare_variation(root, own);
  core::merge_over(root, std::move(own), nullptr, problems);
}

}  // namespace

std::vector<std::string> world_folders(const std::vector<std::string>& search) {
  std::vector<std::string> folders;
  for (const std::string& folder : search) folders.push_back(folder + "/sim/worlds");
  return folders;
}

WorldDescription load_world(const std::string& path, Diagnostics& diagnostics,
                            const std::vector<std::string>& search, const WorldSettings& settings) {
  WorldDescription world = core::load_over_base(
      path, false, diagnostics,
      [&](const YamlNode& root, Diagnostics& problems) {
        YamlNode whole = root;
        for (const auto& [key, value] : settings) lay_over(whole, key, value, problems);
        return WorldLoader(path, problems).load(whole);
      },
      model::prepare_variation, world_folders(core::search_from(path, search)));
  return world;
}

}  // namespace footfall::sim
