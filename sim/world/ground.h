// `ground:` and `terrain_belief:` of a world file: pieces of terrain, and what the controller takes
// them for. Load time only.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/yaml/yaml.h"
#include "model/terrain.h"
#include "model/variation/variation.h"

namespace footfall::sim {

// A box, turned about the centre of its top face by R = Rz(yaw) Ry(pitch) Rx(roll).
struct TerrainBox {
  std::array<double, 2> at{};    // m, centre of the top face in the world's x y
  std::array<double, 3> size{};  // m, full edges
  std::optional<double> top;     // m, height of that centre; nullopt: it stands on the plane
  std::array<double, 3> turn{};  // rad, roll, pitch, yaw
  core::Mark mark;
};

struct GroundSettings {
  double friction = 0.9;
  double height_error = 0.0;  // m, largest: the ground's height is drawn anew for every step
  std::vector<TerrainBox> terrain;
};

// What the controller believes of the terrain.
enum class TerrainBelief { exact, flat };

void read_ground(const core::YamlNode& node, GroundSettings& ground,
                 core::Diagnostics& diagnostics);

// `belief` with the error of its draw in `error`; its boxes are counted by the caller.
void read_belief(const core::YamlNode& node, TerrainBelief& belief, model::TerrainError& error,
                 core::Diagnostics& diagnostics);

model::TerrainPiece piece_of(const TerrainBox& box);
model::Terrain terrain_of(const std::vector<TerrainBox>& boxes);

// A piece as it is believed with what was drawn: turned about the centre of its top face by a
// rotation vector (tilt: x and y, rad, world) and lifted.
model::TerrainPiece mistaken(const model::TerrainPiece& piece, const model::DrawnTerrain& drawn);

}  // namespace footfall::sim
