// Signed distances; see terrain.h.
#include "model/terrain.h"

#include <algorithm>
#include <cmath>

namespace footfall::model {
namespace {

using Vector = std::array<double, 3>;

// Of a box: in its own axes the closest point is the point cut to its edges.
GroundAt nearest_of(const TerrainPiece& box, const Vector& point) noexcept {
  Vector local{}, out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      local[i] += box.R_WP[3 * k + i] * (point[k] - box.centre[k]);
    }
  }
  double square = 0.0;
  std::size_t shallow = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double beyond = std::max(std::abs(local[i]) - box.half[i], 0.0);
    out[i] = std::copysign(beyond, local[i]);
    square += beyond * beyond;
    if (box.half[i] - std::abs(local[i]) < box.half[shallow] - std::abs(local[shallow])) {
      shallow = i;
    }
  }
  GroundAt found;
  if (square > 0.0) {
    found.distance = std::sqrt(square);
    for (double& x : out) x /= found.distance;
  } else {
    found.distance = std::abs(local[shallow]) - box.half[shallow];
    out[shallow] = std::copysign(1.0, local[shallow]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    found.normal[i] =
        box.R_WP[3 * i] * out[0] + box.R_WP[3 * i + 1] * out[1] + box.R_WP[3 * i + 2] * out[2];
  }
  return found;
}

// Of its highest corner, m.
double top_of(const TerrainPiece& box) noexcept {
  double top = box.centre[2];
  for (std::size_t i = 0; i < 3; ++i) top += std::abs(box.R_WP[6 + i]) * box.half[i];
  return top;
}

}  // namespace

GroundAt Terrain::nearest(const Vector& point) const noexcept {
  GroundAt least;
  least.distance = point[2];
  for (const TerrainPiece& box : boxes) {
    const GroundAt found = nearest_of(box, point);
    if (found.distance < least.distance) least = found;
  }
  return least;
}

// The ball may sink by what it is clear of the ground: that passes through nothing. On a slope of
// 45 deg each time leaves 0.3 of the way; beside a steep face the limit ends a long approach.
double Terrain::rest_height(double x, double y, double radius) const noexcept {
  double z = radius;
  for (const TerrainPiece& box : boxes) z = std::max(z, top_of(box) + radius);
  constexpr int kMost = 1000;
  constexpr double kClose = 1e-12;  // m
  for (int i = 0; i < kMost && !boxes.empty(); ++i) {
    const double clear = nearest({x, y, z}).distance - radius;
    if (clear < kClose) break;
    z -= clear;
  }
  return z;
}

}  // namespace footfall::model
