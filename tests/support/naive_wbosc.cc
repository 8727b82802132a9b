// See naive_wbosc.h. Equation numbers are [Kim16]'s.
// Equations: [Kim16] eqs. (28)-(44), as printed but for the corrections of docs/notation.md.
#include "tests/support/naive_wbosc.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace footfall::tests {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Singular values are those of inverse inertias (0.1 to 70 on Hume): far above both thresholds,
// which are far above round-off.
MatrixXd pseudo_inverse(const MatrixXd& M) {
  constexpr double kRelative = 1e-11;
  constexpr double kFloor = 1e-13;
  if (M.size() == 0) return MatrixXd::Zero(M.cols(), M.rows());
  const Eigen::JacobiSVD<MatrixXd> svd(M, Eigen::ComputeThinU | Eigen::ComputeThinV);
  VectorXd s = svd.singularValues();
  const double limit = std::max(kFloor, kRelative * s(0));
  for (double& value : s) value = value > limit ? 1.0 / value : 0.0;
  return svd.matrixV() * s.asDiagonal() * svd.matrixU().transpose();
}

// What the contacts leave: (29), (31)-(35).
struct Constrained {
  MatrixXd A_inv, Lambda_s, Js_bar, Ns, UNs, phi, UNs_bar;
};

Constrained constrain(const NaiveProblem& p) {
  Constrained c;
  const Eigen::Index n = p.A.rows();
  c.A_inv = p.A.inverse();
  c.Lambda_s = pseudo_inverse(p.Js * c.A_inv * p.Js.transpose());
  c.Js_bar = c.A_inv * p.Js.transpose() * c.Lambda_s;
  c.Ns = MatrixXd::Identity(n, n) - c.Js_bar * p.Js;
  c.UNs = p.U * c.Ns;
  c.phi = c.UNs * c.A_inv * c.UNs.transpose();
  c.UNs_bar = c.A_inv * c.UNs.transpose() * pseudo_inverse(c.phi);
  return c;
}

// (36)-(38), level by level; corrected μ*, p* are inside `drift`.
VectorXd task_torque(const NaiveProblem& p, const Constrained& c) {
  const Eigen::Index na = p.U.rows();
  VectorXd tau = VectorXd::Zero(na);
  MatrixXd N_prev = MatrixXd::Identity(na, na);
  const VectorXd drift =
      c.A_inv * (c.Ns.transpose() * p.h + p.Js.transpose() * c.Lambda_s * p.Js_bias);
  for (const NaiveLevel& level : p.levels) {
    const MatrixXd J_star = level.J * c.UNs_bar * N_prev;
    const MatrixXd Lambda = pseudo_inverse(J_star * c.phi * J_star.transpose());
    const VectorXd F = Lambda * (level.u - level.J_bias + level.J * drift -
                                 level.J * c.A_inv * c.UNs.transpose() * tau);
    tau += J_star.transpose() * F;
    N_prev = (MatrixXd::Identity(na, na) - c.phi * J_star.transpose() * Lambda * J_star) * N_prev;
  }
  return tau;
}

// (32): force of the robot on the ground.
VectorXd reaction(const NaiveProblem& p, const Constrained& c, const VectorXd& tau) {
  return c.Js_bar.transpose() * (p.U.transpose() * tau - p.h) + c.Lambda_s * p.Js_bias;
}

// (39)-(44) with E6, E7: only what the tasks' torques leave is added.
VectorXd internal_torque(const NaiveProblem& p, const Constrained& c, const VectorXd& tau_task) {
  const Eigen::Index na = p.U.rows();
  const MatrixXd L_star = MatrixXd::Identity(na, na) - c.UNs * c.UNs_bar;
  const MatrixXd J_il_bar = L_star * p.U * c.Js_bar * p.W_int.transpose();
  const MatrixXd J_il_star = pseudo_inverse(J_il_bar);
  const VectorXd F_task = p.W_int * c.Js_bar.transpose() * p.U.transpose() * tau_task;
  const VectorXd mu_p = p.W_int * (c.Js_bar.transpose() * p.h - c.Lambda_s * p.Js_bias);
  VectorXd wanted = p.F_int;
  if (p.tau_measured.size() > 0) {
    wanted += p.K_F.cwiseProduct(p.F_int - p.W_int * reaction(p, c, p.tau_measured));
  }
  return J_il_star.transpose() * (wanted - F_task + mu_p);
}

}  // namespace

NaiveSolution naive_wbosc(const NaiveProblem& p) {
  const Constrained c = constrain(p);
  NaiveSolution s;
  s.tau = task_torque(p, c);
  if (p.W_int.rows() > 0) s.tau += internal_torque(p, c, s.tau);
  s.F_r = reaction(p, c, s.tau);
  return s;
}

MatrixXd naive_effective_inertia(const NaiveProblem& p, const MatrixXd& J) {
  const Constrained c = constrain(p);
  const MatrixXd J_star = J * c.UNs_bar;
  return pseudo_inverse(J_star * c.phi * J_star.transpose());
}

NaiveProblem dense_problem(const model::ControlModel& model, const tasks::WboscProblem& p) {
  const int n = model.nv();
  const int na = model.joint_count();
  NaiveProblem d;
  RowMajor A(n, n);
  model.mass_matrix(A.data());
  d.A = A;
  d.h = Eigen::Map<const VectorXd>(p.bias, n) - Eigen::Map<const VectorXd>(p.external.data(), n);
  d.U = MatrixXd::Zero(na, n);
  for (int j = 0; j < na; ++j) d.U(j, p.actuated[j]) = 1.0;
  d.Js = Eigen::Map<const RowMajor>(p.Js.data(), p.contact_rows, n);
  d.Js_bias = Eigen::Map<const VectorXd>(p.Js_bias.data(), p.contact_rows);
  int first = 0;
  for (int k = 0; k < p.levels; ++k) {
    const int rows = p.level_end[static_cast<std::size_t>(k)] - first;
    NaiveLevel level;
    level.J = Eigen::Map<const RowMajor>(p.J.data() + first * n, rows, n);
    level.J_bias = Eigen::Map<const VectorXd>(p.J_bias.data() + first, rows);
    level.u = Eigen::Map<const VectorXd>(p.u.data() + first, rows);
    for (int i = 0; i < rows; ++i) {
      const double w = std::sqrt(p.weight[static_cast<std::size_t>(first + i)]);
      level.J.row(i) *= w;
      level.J_bias(i) *= w;
      level.u(i) *= w;
    }
    d.levels.push_back(level);
    first += rows;
  }
  // F_r = -f: a row on the ground's force changes its sign.
  d.W_int = -Eigen::Map<const RowMajor>(p.W_int.data(), p.internal_rows, p.contact_rows);
  d.F_int = Eigen::Map<const VectorXd>(p.F_int.data(), p.internal_rows);
  d.K_F = Eigen::Map<const VectorXd>(p.K_F.data(), p.internal_rows);
  if (p.tau_measured) d.tau_measured = Eigen::Map<const VectorXd>(p.tau_measured, na);
  return d;
}

}  // namespace footfall::tests
