// Eq. (30) of [Kim16] without any structure: the equations of motion and the contact constraint as
// one linear system, solved by full-pivot LU. The oracle of every WBOSC test.
#pragma once

#include <Eigen/LU>

namespace footfall::tests {

struct DenseMotion {
  Eigen::VectorXd qdd;  // n
  Eigen::VectorXd f;    // contact rows, ground on robot
};

//   | A   -Jsᵀ | | q̈ |   | Uᵀτ - h    |
//   | Js   0   | | f |  = | -J̇s q̇     |
inline DenseMotion dense_solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& h,
                               const Eigen::MatrixXd& U, const Eigen::MatrixXd& Js,
                               const Eigen::VectorXd& Js_bias, const Eigen::VectorXd& tau) {
  const Eigen::Index n = A.rows();
  const Eigen::Index m = Js.rows();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m);
  K.topLeftCorner(n, n) = A;
  K.topRightCorner(n, m) = -Js.transpose();
  K.bottomLeftCorner(m, n) = Js;
  Eigen::VectorXd right(n + m);
  right << U.transpose() * tau - h, -Js_bias;
  // Redundant contacts make K singular: full pivoting finds one solution, whose q̈ is unique.
  Eigen::FullPivLU<Eigen::MatrixXd> lu(K);
  lu.setThreshold(1e-11);
  const Eigen::VectorXd x = lu.solve(right);
  return {x.head(n), x.tail(m)};
}

}  // namespace footfall::tests
