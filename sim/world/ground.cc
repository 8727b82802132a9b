// Reading and placing of terrain; see ground.h.
#include "sim/world/ground.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/yaml/value_reader.h"
#include "sim/world/keys.h"

namespace footfall::sim {
namespace {

using core::Diagnostics;
using core::YamlNode;
using Vector = std::array<double, 3>;
using Matrix = std::array<double, 9>;  // row-major

constexpr double kMostTilt = 0.5 * std::numbers::pi;

void read_limited(const YamlNode& map, std::string_view key, core::Dimension dimension,
                  double least, double most, double& out, Diagnostics& diagnostics,
                  std::string_view what = {}) {
  const YamlNode* const node = map.find(key);
  if (node == nullptr) return;
  out = core::read_bounded(*node, dimension, least, most, diagnostics, what).value_or(out);
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    }
  }
  return c;
}

Matrix rotation_of(const Vector& rpy) {
  const double cr = std::cos(rpy[0]), sr = std::sin(rpy[0]);
  const double cp = std::cos(rpy[1]), sp = std::sin(rpy[1]);
  const double cy = std::cos(rpy[2]), sy = std::sin(rpy[2]);
  return product({cy, -sy, 0, sy, cy, 0, 0, 0, 1},
                 product({cp, 0, sp, 0, 1, 0, -sp, 0, cp}, {1, 0, 0, 0, cr, -sr, 0, sr, cr}));
}

// From the centre of the top face to that of the box.
Vector centre_below(const Vector& top, const Matrix& R, double half_height) {
  return {top[0] - R[2] * half_height, top[1] - R[5] * half_height, top[2] - R[8] * half_height};
}

double highest_of(const model::TerrainPiece& piece) {
  double z = piece.centre[2];
  for (std::size_t i = 0; i < 3; ++i) z += std::abs(piece.R_WP[6 + i]) * piece.half[i];
  return z;
}

// z and the angles; the size is known.
void read_place(const YamlNode& node, TerrainBox& box, Diagnostics& diagnostics) {
  constexpr double kFar = 100.0;  // m
  if (const YamlNode* z = node.find("z")) {
    box.top = core::read_bounded(*z, core::kLength, -kFar, kFar, diagnostics, "a height");
  }
  constexpr const char* kAngle = "an angle within 90 deg";
  read_limited(node, "roll", core::kNone, -kMostTilt, kMostTilt, box.turn[0], diagnostics, kAngle);
  read_limited(node, "pitch", core::kNone, -kMostTilt, kMostTilt, box.turn[1], diagnostics, kAngle);
  read_limited(node, "yaw", core::kNone, -std::numbers::pi, std::numbers::pi, box.turn[2],
               diagnostics, "an angle within 180 deg");
}

void read_box(const YamlNode& node, std::vector<TerrainBox>& terrain, Diagnostics& diagnostics) {
  if (!core::expect_map(node, "a box: {at: [X, Y], size: [X, Y, Z]}", diagnostics)) return;
  core::check_keys(node, kBoxKeys, diagnostics);
  TerrainBox box;
  box.mark = node.mark;
  if (const YamlNode* at = core::require_key(node, "at", diagnostics)) {
    const auto values = core::read_vector(*at, core::kLength, {"x", "y"}, diagnostics);
    if (values) std::copy(values->begin(), values->end(), box.at.begin());
  }
  bool good = false;
  if (const YamlNode* size = core::require_key(node, "size", diagnostics)) {
    const auto values = core::read_vector3(*size, core::kLength, diagnostics);
    box.size = values.value_or(box.size);
    const auto above_zero = [](double length) { return length > 0.0; };
    good = values && std::ranges::all_of(*values, above_zero);
    if (values && !good) {
      diagnostics.error(size->mark, "out-of-range", "expected lengths above zero for a box");
    }
  }
  read_place(node, box, diagnostics);
  if (good && !(highest_of(piece_of(box)) > 0.0)) {
    diagnostics.error(node.find("z") ? node.find("z")->mark : node.mark, "out-of-range",
                      "the box lies below the plane z = 0, which is solid: expected a height 'z' "
                      "at which it rises above that");
  }
  terrain.push_back(box);
}

void read_error(const YamlNode& node, model::TerrainError& error, Diagnostics& diagnostics) {
  if (!core::expect_map(node, "{tilt: ANGLE, height: LENGTH}", diagnostics)) return;
  core::check_keys(node, kBeliefErrorKeys, diagnostics);
  read_limited(node, "tilt", core::kNone, 0.0, 0.5, error.tilt, diagnostics,
               "an angle within 0.5 rad");
  read_limited(node, "height", core::kLength, 0.0, 1.0, error.height, diagnostics, "a height");
}

}  // namespace

void read_ground(const YamlNode& node, GroundSettings& ground, Diagnostics& diagnostics) {
  if (!core::expect_map(node, "{friction: NUMBER, height_error: LENGTH, terrain: [...]}",
                        diagnostics)) {
    return;
  }
  core::check_keys(node, kGroundKeys, diagnostics);
  constexpr double kLargestFriction = 10.0;
  read_limited(node, "friction", core::kNone, 0.0, kLargestFriction, ground.friction, diagnostics);
  constexpr double kLargestError = 0.02;  // m; a foot must swing clear of it
  read_limited(node, "height_error", core::kLength, 0.0, kLargestError, ground.height_error,
               diagnostics);
  const YamlNode* const terrain = node.find("terrain");
  if (terrain == nullptr ||
      !core::expect_sequence(*terrain, "a list of terrain pieces", diagnostics)) {
    return;
  }
  for (const YamlNode& piece : terrain->items) {
    if (!core::expect_map(piece, "a terrain piece: {box: {at: [X, Y], size: [X, Y, Z]}}",
                          diagnostics)) {
      continue;
    }
    core::check_keys(piece, kTerrainKeys, diagnostics);
    const YamlNode* const box = core::require_key(piece, "box", diagnostics);
    if (box != nullptr) read_box(*box, ground.terrain, diagnostics);
  }
}

void read_belief(const YamlNode& node, TerrainBelief& belief, model::TerrainError& error,
                 Diagnostics& diagnostics) {
  if (!node.is_map()) {
    const auto choice = core::read_choice(node, kTerrainBeliefs, diagnostics,
                                          "exact, flat or {error: {tilt: ANGLE, height: LENGTH}}");
    if (choice) belief = static_cast<TerrainBelief>(*choice);
    return;
  }
  core::check_keys(node, kBeliefKeys, diagnostics);
  if (const YamlNode* map = core::require_key(node, "error", diagnostics)) {
    read_error(*map, error, diagnostics);
  }
}

model::TerrainPiece piece_of(const TerrainBox& box) {
  model::TerrainPiece piece;
  piece.R_WP = rotation_of(box.turn);
  for (std::size_t k = 0; k < 3; ++k) piece.half[k] = 0.5 * box.size[k];
  piece.centre = centre_below({box.at[0], box.at[1], box.top.value_or(box.size[2])}, piece.R_WP,
                              piece.half[2]);
  return piece;
}

model::Terrain terrain_of(const std::vector<TerrainBox>& boxes) {
  model::Terrain terrain;
  for (const TerrainBox& box : boxes) terrain.boxes.push_back(piece_of(box));
  return terrain;
}

model::TerrainPiece mistaken(const model::TerrainPiece& piece, const model::DrawnTerrain& drawn) {
  model::TerrainPiece out = piece;
  const double angle = std::hypot(drawn.tilt[0], drawn.tilt[1]);
  if (angle > 0.0) {  // Rodrigues about a horizontal axis
    const double x = drawn.tilt[0] / angle, y = drawn.tilt[1] / angle;
    const double c = std::cos(angle), s = std::sin(angle), v = 1.0 - c;
    out.R_WP = product(
        {c + v * x * x, v * x * y, s * y, v * x * y, c + v * y * y, -s * x, -s * y, s * x, c},
        piece.R_WP);
  }
  Vector top{};
  for (std::size_t k = 0; k < 3; ++k) {
    top[k] = piece.centre[k] + piece.R_WP[3 * k + 2] * piece.half[2];
  }
  top[2] += drawn.height;
  out.centre = centre_below(top, out.R_WP, piece.half[2]);
  return out;
}

}  // namespace footfall::sim
