// Rotations, their tangent vectors and the closest rotation.
#include "engine/estimators/parts/rotation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>

#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

using engine::Matrix3d;
using engine::Vector3d;

Vector3d random_vector(Random& random, double limit) {
  return {random.within(limit), random.within(limit), random.within(limit)};
}

TEST(Rotation, TheExponentialIsTheTurnAboutTheVectorByItsLength) {
  Random random(1);
  for (const double size : {1e-9, 1e-4, 0.9e-3, 1.1e-3, 0.3, 2.0}) {
    const Vector3d v = random_vector(random, 1.0).normalized() * size;
    const Matrix3d expected = Eigen::AngleAxisd(size, v.normalized()).toRotationMatrix();
    EXPECT_LT((engine::rotation_exp(v) - expected).norm(), 1e-14) << size;
    EXPECT_LT((engine::rotation_log(engine::rotation_exp(v)) - v).norm(), 1e-12) << size;
  }
}

TEST(Rotation, TheLeftJacobianIsTheExponentialsDerivative) {
  Random random(2);
  const double step = 1e-6;  // central differences: an error of step^2 and of rounding/step
  for (const double size : {1e-5, 0.4, 1.5}) {
    const Vector3d v = random_vector(random, 1.0).normalized() * size;
    const Matrix3d J = engine::left_jacobian(v);
    for (int k = 0; k < 3; ++k) {
      const Vector3d d = step * Vector3d::Unit(k);
      const Matrix3d turn = engine::rotation_exp(v + d) * engine::rotation_exp(v - d).transpose();
      EXPECT_LT((engine::rotation_log(turn) / (2.0 * step) - J.col(k)).norm(), 1e-9);
    }
  }
}

// The oracle: U diag(1, 1, det) Vᵀ maximises tr(AᵀR) over the rotations.
Matrix3d by_decomposition(const Matrix3d& A) {
  const Eigen::JacobiSVD<Matrix3d> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d D = Matrix3d::Identity();
  D(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * D * svd.matrixV().transpose();
}

TEST(Rotation, TheClosestRotationIsThatOfTheSingularValueDecomposition) {
  Random random(3);
  for (const double distance : {1e-6, 0.01, 0.1, 0.3, 3.0}) {
    for (int i = 0; i < 50; ++i) {
      Matrix3d A = engine::rotation_exp(random_vector(random, 2.0));
      for (int k = 0; k < 9; ++k) A(k) += random.within(distance);
      const Matrix3d R = engine::closest_rotation(A);
      EXPECT_LT((R - by_decomposition(A)).norm(), 1e-10) << distance;
      EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
    }
  }
}

TEST(Rotation, AMirrorIsNoRotation) {
  const Matrix3d mirror = Vector3d(1.0, 1.0, -0.9).asDiagonal();
  EXPECT_LT((engine::closest_rotation(mirror) - Matrix3d::Identity()).norm(), 1e-12);
}

TEST(Rotation, QuaternionsAreThoseOfTheMatrix) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Matrix3d R = engine::rotation_exp(random_vector(random, 3.0));
    const auto q = engine::quaternion_of(R);
    EXPECT_GE(q[0], 0.0);
    EXPECT_LT((engine::rotation_of(q) - R).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace footfall::tests
