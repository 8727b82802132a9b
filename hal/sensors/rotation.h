// Rotations of a base that turns a little in a tick: quaternions w x y z, from base to world axes.
#pragma once

#include <array>
#include <cmath>

namespace footfall::hal {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<double, 9>;  // row-major
using Quaternion = std::array<double, 4>;

inline Vector3 cross(const Vector3& a, const Vector3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// R v.
inline Vector3 turned(const Matrix3& r, const Vector3& v) noexcept {
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
          r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}

// Rᵀ v.
inline Vector3 turned_back(const Matrix3& r, const Vector3& v) noexcept {
  return {r[0] * v[0] + r[3] * v[1] + r[6] * v[2], r[1] * v[0] + r[4] * v[1] + r[7] * v[2],
          r[2] * v[0] + r[5] * v[1] + r[8] * v[2]};
}

// Of a quaternion whose length need not be 1.
inline Matrix3 matrix_of(const Quaternion& q) noexcept {
  const double s = 2.0 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const double xx = s * q[1] * q[1], yy = s * q[2] * q[2], zz = s * q[3] * q[3];
  const double xy = s * q[1] * q[2], xz = s * q[1] * q[3], yz = s * q[2] * q[3];
  const double wx = s * q[0] * q[1], wy = s * q[0] * q[2], wz = s * q[0] * q[3];
  return {1.0 - yy - zz, xy - wz, xz + wy, xy + wz,      1.0 - xx - zz,
          yz - wx,       xz - wy, yz + wx, 1.0 - xx - yy};
}

// The rotation vector from a to b, in the axes of both: log(Rₐᵀ R_b), rad.
inline Vector3 rotation_between(const Quaternion& a, const Quaternion& b) noexcept {
  const double w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const Vector3 u = {a[1], a[2], a[3]}, v = {b[1], b[2], b[3]};
  const Vector3 n = cross(v, u);
  Vector3 axis{};  // sin(angle / 2) times the axis
  for (std::size_t k = 0; k < 3; ++k) axis[k] = a[0] * v[k] - b[0] * u[k] + n[k];
  const double sine = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  // The shorter way round: q and -q are the same rotation.
  const double half = std::atan2(sine, std::abs(w));
  const double scale = (sine > 0.0 ? 2.0 * half / sine : 2.0) * (w < 0.0 ? -1.0 : 1.0);
  for (double& x : axis) x *= scale;
  return axis;
}

// The orientation half-way from a to b, of any length.
inline Quaternion between(const Quaternion& a, const Quaternion& b) noexcept {
  const double w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  Quaternion out{};
  for (std::size_t k = 0; k < 4; ++k) out[k] = a[k] + (w < 0.0 ? -b[k] : b[k]);
  return out;
}

}  // namespace footfall::hal
