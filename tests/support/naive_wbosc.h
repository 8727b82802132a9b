// Appendix A of [Kim16] taken literally (with the corrections of docs/notation.md), for comparison:
// dynamic matrices, A⁻¹ formed, an SVD for every bar-inverse. Slow, plain, and written from the
// formulas, not from tasks/solver/wbosc.
#pragma once

#include <vector>

#include "model/control_model.h"
#include "tasks/solver/wbosc.h"
#include "tests/support/matrix.h"

namespace footfall::tests {

struct NaiveLevel {
  Matrix J;       // rows x n
  Matrix J_bias;  // J̇q̇
  Matrix u;
};

struct NaiveProblem {
  Matrix A;        // n x n
  Matrix h;        // b + g - known external forces
  Matrix U;        // na x n
  Matrix Js;       // contact rows x n
  Matrix Js_bias;  // J̇s q̇
  std::vector<NaiveLevel> levels;
  Matrix W_int;  // acts on F_r, the force of the robot ON the ground
  Matrix F_int;
  Matrix K_F;
  Matrix tau_measured;  // empty: no feedback
};

struct NaiveSolution {
  Matrix tau;
  Matrix F_r;  // robot on ground
};

NaiveSolution naive_wbosc(const NaiveProblem& problem);

// The same problem as dense matrices. Rows are scaled by the root of their weight.
NaiveProblem dense_problem(const model::ControlModel& model, const tasks::WboscProblem& problem);

}  // namespace footfall::tests
