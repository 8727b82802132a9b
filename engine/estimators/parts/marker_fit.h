// Affine least squares of a frame of motion capture: [Kim16] Appendix C, eq. (53) to (57) with the
// corrections E15 and E16 (docs/notation.md).
#pragma once

#include <span>

#include "engine/estimators/parts/rotation.h"

namespace footfall::engine {

// A marker that is seen: where it is on the base, and where it was seen.
struct MarkerPair {
  Vector3d place;     // z, m, base axes from the base's origin
  Vector3d position;  // y, m, world
};

struct AffineFit {
  Matrix3d A = Matrix3d::Identity();
  Vector3d mean_place = Vector3d::Zero();     // m
  Vector3d mean_position = Vector3d::Zero();  // m
  int markers = 0;
  // The base's origin for an orientation, t = mean y - A mean z.
  Vector3d origin(const Matrix3d& R) const noexcept { return mean_position - R * mean_place; }
};

// The minimum over t and A of
//   sum_i |t + A z_i - y_i|^2 + lambda^2 |A - A_predicted|_F^2,    lambda in m.
// t is free, so it is eliminated by centring on the seen markers; then, with Z, Y the centred
// columns, in closed form
//   A = (Y Zᵀ + lambda^2 A_predicted) (Z Zᵀ + lambda^2 I)^-1.
// Any number of markers from 1 on has a solution if lambda > 0.
AffineFit fit_affine(std::span<const MarkerPair> markers, const Matrix3d& A_predicted,
                     double lambda) noexcept;

// The rotation of a frame without a prediction: min sum_i |t + R z_i - y_i|^2 over rotations. False
// if fewer than three markers are seen, or all lie on a line (second singular value of Y Zᵀ below
// 1e-4 m^2: a spread of 1 cm).
bool fit_rotation(std::span<const MarkerPair> markers, Matrix3d& R) noexcept;

// Root mean square of |t + R z_i - y_i|, m.
double marker_residual(std::span<const MarkerPair> markers, const Matrix3d& R,
                       const Vector3d& origin) noexcept;

}  // namespace footfall::engine
