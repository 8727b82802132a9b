// Rotations as 3 x 3 matrices and their tangent vectors, for estimators.
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace footfall::engine {

using Vector3d = Eigen::Vector3d;
using Matrix3d = Eigen::Matrix3d;

inline Eigen::Map<const Vector3d> vector_of(const std::array<double, 3>& v) noexcept {
  return Eigen::Map<const Vector3d>(v.data());
}
inline std::array<double, 3> array_of(const Vector3d& v) noexcept { return {v[0], v[1], v[2]}; }
// Row-major, as models and sensors give it.
inline Matrix3d matrix_of(const std::array<double, 9>& R) noexcept {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.data());
}

// [v]x, so that [v]x u = v x u.
Matrix3d skew(const Vector3d& v) noexcept;
// The rotation about v by its length, rad.
Matrix3d rotation_exp(const Vector3d& v) noexcept;
// Its inverse, for angles below pi.
Vector3d rotation_log(const Matrix3d& R) noexcept;
// Left Jacobian of the exponential: exp((v + d)) = exp(J d) exp(v) to first order in d.
Matrix3d left_jacobian(const Vector3d& v) noexcept;

// The rotation closest to A in the Frobenius norm, with determinant +1: V diag(1, 1, det) Uᵀ of
// the singular value decomposition. For a regular A near a rotation (det > 0) by Newton's iteration
// on the polar factor, which agrees with the decomposition to rounding; else by the decomposition.
Matrix3d closest_rotation(const Matrix3d& A) noexcept;

// w x y z, w >= 0. The first for a rotation matrix to rounding.
std::array<double, 4> quaternion_of(const Matrix3d& R) noexcept;
Matrix3d rotation_of(const std::array<double, 4>& q) noexcept;

}  // namespace footfall::engine
