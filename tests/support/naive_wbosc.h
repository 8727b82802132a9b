// Appendix A of [Kim16] taken literally (with the corrections of docs/notation.md), for comparison:
// dynamic matrices, A⁻¹ formed, an SVD for every bar-inverse. Slow, plain, and written from the
// formulas, not from tasks/solver/wbosc.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/control_model.h"
#include "tasks/solver/wbosc.h"

namespace footfall::tests {

struct NaiveLevel {
  Eigen::MatrixXd J;       // rows x n
  Eigen::VectorXd J_bias;  // J̇q̇
  Eigen::VectorXd u;
};

struct NaiveProblem {
  Eigen::MatrixXd A;        // n x n
  Eigen::VectorXd h;        // b + g - known external forces
  Eigen::MatrixXd U;        // na x n
  Eigen::MatrixXd Js;       // contact rows x n
  Eigen::VectorXd Js_bias;  // J̇s q̇
  std::vector<NaiveLevel> levels;
  Eigen::MatrixXd W_int;  // acts on F_r, the force of the robot ON the ground
  Eigen::VectorXd F_int;
  Eigen::VectorXd K_F;
  Eigen::VectorXd tau_measured;  // empty: no feedback
};

struct NaiveSolution {
  Eigen::VectorXd tau;
  Eigen::VectorXd F_r;  // robot on ground
};

NaiveSolution naive_wbosc(const NaiveProblem& problem);

// Λ* = (J* φ J*ᵀ)⁺ of rows J alone.
Eigen::MatrixXd naive_effective_inertia(const NaiveProblem& problem, const Eigen::MatrixXd& J);

// The same problem as dense matrices. Rows are scaled by the root of their weight.
NaiveProblem dense_problem(const model::ControlModel& model, const tasks::WboscProblem& problem);

}  // namespace footfall::tests
