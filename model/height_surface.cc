// Ramps of the walking surface; see height_surface.h.
#include "model/height_surface.h"

namespace footfall::model {

SurfacePoint HeightSurface::at(double x) const noexcept {
  SurfacePoint point;
  for (const SurfaceRamp& ramp : ramps) {
    if (x <= ramp.from) continue;
    if (x >= ramp.to) {
      point.height += ramp.rise;
      continue;
    }
    const double length = ramp.to - ramp.from;
    const double s = (x - ramp.from) / length;
    const double r = 1.0 - s;
    point.height += ramp.rise * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    point.slope += ramp.rise / length * 30.0 * s * s * r * r;
    point.curvature += ramp.rise / (length * length) * 60.0 * s * r * (1.0 - 2.0 * s);
  }
  return point;
}

}  // namespace footfall::model
