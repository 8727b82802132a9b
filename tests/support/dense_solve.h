// Eq. (30) of [Kim16] without any structure: the equations of motion and the contact constraint as
// one linear system, solved by full-pivot LU. The oracle of every WBOSC test.
#pragma once

#include "tests/support/naive_wbosc.h"

namespace footfall::tests {

struct DenseMotion {
  Matrix qdd;  // n
  Matrix f;    // contact rows, ground on robot
};

//   | A   -Jsᵀ | | q̈ |   | Uᵀτ - h    |
//   | Js   0   | | f |  = | -J̇s q̇     |
inline DenseMotion dense_solve(const NaiveProblem& p, const Matrix& tau) {
  const int n = p.A.rows();
  const int m = p.Js.rows();
  Matrix K(n + m, n + m), right(n + m);
  K.set_block(0, 0, p.A);
  K.set_block(0, n, -p.Js.transpose());
  K.set_block(n, 0, p.Js);
  right.set_block(0, 0, p.U.transpose() * tau - p.h);
  right.set_block(n, 0, -p.Js_bias);
  // Redundant contacts make K singular: full pivoting finds one solution, whose q̈ is unique.
  const Matrix x = solve(K, right, 1e-11);
  return {x.head(n), x.tail(m)};
}

}  // namespace footfall::tests
