// The ground as geometry: the level plane z = 0 and boxes on it, upright or inclined. Its normals
// say where a foot's ball touches and which way the ground pushes.
#pragma once

#include <array>
#include <vector>

namespace footfall::model {

// A solid box. Columns of R_WP are the directions of its edges.
struct TerrainPiece {
  std::array<double, 3> centre{};                         // m, world
  std::array<double, 9> R_WP{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major
  std::array<double, 3> half{};                           // m, half of its edges

  bool operator==(const TerrainPiece&) const = default;
};

// Where a point is against the ground's surface.
struct GroundAt {
  std::array<double, 3> normal{0.0, 0.0, 1.0};  // unit, out of the ground
  double distance = 0.0;                        // m, negative inside
};

struct Terrain {
  std::vector<TerrainPiece> boxes;

  // The nearest of the pieces by signed distance; of two alike the plane, then the first box. The
  // normal is the gradient of the distance: from the closest point to the point, and of a point
  // inside a box that of the face of least depth. On the level plane it is (0, 0, 1) exactly. No
  // allocation.
  GroundAt nearest(const std::array<double, 3>& point) const noexcept;

  // Height, m, at which a ball's centre comes to rest when it is let down at x y from above: its
  // distance is the radius. No allocation.
  double rest_height(double x, double y, double radius) const noexcept;

  bool operator==(const Terrain&) const = default;
};

}  // namespace footfall::model
