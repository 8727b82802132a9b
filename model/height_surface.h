// The height of a world's walking surface along x, as the CoM's height is to follow it: flat with
// smooth ramps. A copy is a few numbers; at() allocates nothing.
#pragma once

#include <vector>

namespace footfall::model {

// From x = from to x = to (to > from) the surface rises by `rise` (negative: falls), all in m, as
// s^3 (10 - 15 s + 6 s^2) with s from 0 to 1: slope and curvature are 0 at both ends.
struct SurfaceRamp {
  double from = 0.0;
  double to = 0.0;
  double rise = 0.0;
};

struct SurfacePoint {
  double height = 0.0;     // m
  double slope = 0.0;      // dz/dx
  double curvature = 0.0;  // d2z/dx2, 1/m
};

struct HeightSurface {
  std::vector<SurfaceRamp> ramps;  // their rises add up

  SurfacePoint at(double x) const noexcept;
};

}  // namespace footfall::model
