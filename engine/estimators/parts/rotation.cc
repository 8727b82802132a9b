// Rotations; see rotation.h.
#include "engine/estimators/parts/rotation.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace footfall::engine {
namespace {

// Below this angle the series to fourth order is exact to rounding.
constexpr double kSmallAngle = 1e-3;

}  // namespace

Matrix3d skew(const Vector3d& v) noexcept {
  Matrix3d S;
  S << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return S;
}

Matrix3d rotation_exp(const Vector3d& v) noexcept {
  const double square = v.squaredNorm();
  double a = 0.0, b = 0.0;  // sin x / x, (1 - cos x) / x^2
  if (square < kSmallAngle * kSmallAngle) {
    a = 1.0 - square / 6.0 * (1.0 - square / 20.0);
    b = 0.5 - square / 24.0 * (1.0 - square / 30.0);
  } else {
    const double angle = std::sqrt(square);
    a = std::sin(angle) / angle;
    b = (1.0 - std::cos(angle)) / square;
  }
  Matrix3d R = b * v * v.transpose() + a * skew(v);
  R.diagonal().array() += 1.0 - b * square;
  return R;
}

Vector3d rotation_log(const Matrix3d& R) noexcept {
  const Vector3d twice_sin(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  const double sine = 0.5 * twice_sin.norm();
  const double cosine = 0.5 * (R.trace() - 1.0);
  if (sine < kSmallAngle && cosine > 0.0) return 0.5 * twice_sin * (1.0 + sine * sine / 6.0);
  if (sine > kSmallAngle) return 0.5 * twice_sin * (std::atan2(sine, cosine) / sine);
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

Matrix3d left_jacobian(const Vector3d& v) noexcept {
  const double square = v.squaredNorm();
  double b = 0.0, c = 0.0;  // (1 - cos x) / x^2, (x - sin x) / x^3
  if (square < kSmallAngle * kSmallAngle) {
    b = 0.5 - square / 24.0;
    c = 1.0 / 6.0 - square / 120.0;
  } else {
    const double angle = std::sqrt(square);
    b = (1.0 - std::cos(angle)) / square;
    c = (angle - std::sin(angle)) / (square * angle);
  }
  const Matrix3d S = skew(v);
  return Matrix3d::Identity() + b * S + c * S * S;
}

Matrix3d closest_rotation(const Matrix3d& A) noexcept {
  constexpr int kIterations = 8;  // from within 0.5 of a rotation it needs 5
  Matrix3d X = A;
  const bool near = (A.transpose() * A - Matrix3d::Identity()).squaredNorm() < 0.25;
  if (near && A.determinant() > 0.0) {
    for (int i = 0; i < kIterations; ++i) {
      // The inverse transpose by cofactors: columns are cross products.
      Matrix3d cofactors;
      cofactors.col(0) = X.col(1).cross(X.col(2));
      cofactors.col(1) = X.col(2).cross(X.col(0));
      cofactors.col(2) = X.col(0).cross(X.col(1));
      const double determinant = X.col(0).dot(cofactors.col(0));
      const Matrix3d next = 0.5 * (X + cofactors / determinant);
      const double change = (next - X).squaredNorm();
      X = next;
      if (change < 1e-16) return X;  // the next change is its square: below rounding
    }
    return X;
  }
  const Eigen::JacobiSVD<Matrix3d> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d signs = Vector3d::Ones();
  signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

std::array<double, 4> quaternion_of(const Matrix3d& R) noexcept {
  Eigen::Quaterniond q(R);
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return {q.w(), q.x(), q.y(), q.z()};
}

Matrix3d rotation_of(const std::array<double, 4>& q) noexcept {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

}  // namespace footfall::engine
