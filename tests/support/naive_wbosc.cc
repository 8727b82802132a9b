// See naive_wbosc.h. Equation numbers are [Kim16]'s.
// Equations: [Kim16] eqs. (28)-(44), as printed but for the corrections of docs/notation.md.
#include "tests/support/naive_wbosc.h"

#include <algorithm>
#include <cmath>

namespace footfall::tests {
namespace {

// What the contacts leave: (29), (31)-(35).
struct Constrained {
  Matrix A_inv, Lambda_s, Js_bar, Ns, UNs, phi, UNs_bar;
};

Constrained constrain(const NaiveProblem& p) {
  Constrained c;
  const int n = p.A.rows();
  c.A_inv = inverse(p.A);
  c.Lambda_s = pseudo_inverse(p.Js * c.A_inv * p.Js.transpose());
  c.Js_bar = c.A_inv * p.Js.transpose() * c.Lambda_s;
  c.Ns = Matrix::identity(n) - c.Js_bar * p.Js;
  c.UNs = p.U * c.Ns;
  c.phi = c.UNs * c.A_inv * c.UNs.transpose();
  c.UNs_bar = c.A_inv * c.UNs.transpose() * pseudo_inverse(c.phi);
  return c;
}

// (36)-(38), level by level; corrected μ*, p* are inside `drift`.
Matrix task_torque(const NaiveProblem& p, const Constrained& c) {
  const int na = p.U.rows();
  Matrix tau(na);
  Matrix N_prev = Matrix::identity(na);
  const Matrix drift =
      c.A_inv * (c.Ns.transpose() * p.h + p.Js.transpose() * c.Lambda_s * p.Js_bias);
  for (const NaiveLevel& level : p.levels) {
    const Matrix J_star = level.J * c.UNs_bar * N_prev;
    const Matrix Lambda = pseudo_inverse(J_star * c.phi * J_star.transpose());
    const Matrix F = Lambda * (level.u - level.J_bias + level.J * drift -
                               level.J * c.A_inv * c.UNs.transpose() * tau);
    tau += J_star.transpose() * F;
    N_prev = (Matrix::identity(na) - c.phi * J_star.transpose() * Lambda * J_star) * N_prev;
  }
  return tau;
}

// (32): force of the robot on the ground.
Matrix reaction(const NaiveProblem& p, const Constrained& c, const Matrix& tau) {
  return c.Js_bar.transpose() * (p.U.transpose() * tau - p.h) + c.Lambda_s * p.Js_bias;
}

// (39)-(44) with E6, E7: only what the tasks' torques leave is added.
Matrix internal_torque(const NaiveProblem& p, const Constrained& c, const Matrix& tau_task) {
  const int na = p.U.rows();
  const Matrix L_star = Matrix::identity(na) - c.UNs * c.UNs_bar;
  const Matrix J_il_bar = L_star * p.U * c.Js_bar * p.W_int.transpose();
  const Matrix J_il_star = pseudo_inverse(J_il_bar);
  const Matrix F_task = p.W_int * c.Js_bar.transpose() * p.U.transpose() * tau_task;
  const Matrix mu_p = p.W_int * (c.Js_bar.transpose() * p.h - c.Lambda_s * p.Js_bias);
  Matrix wanted = p.F_int;
  if (p.tau_measured.size() > 0) {
    const Matrix lacks = p.F_int - p.W_int * reaction(p, c, p.tau_measured);
    for (int i = 0; i < wanted.size(); ++i) wanted(i) += p.K_F(i) * lacks(i);
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

NaiveProblem dense_problem(const model::ControlModel& model, const tasks::WboscProblem& p) {
  const int n = model.nv();
  const int na = model.joint_count();
  NaiveProblem d;
  d.A = Matrix(n, n);
  model.mass_matrix(d.A.data());  // symmetric
  d.h = Matrix::vector(p.bias, n) - Matrix::vector(p.external.data(), n);
  d.U = Matrix(na, n);
  for (int j = 0; j < na; ++j) d.U(j, p.actuated[j]) = 1.0;
  d.Js = Matrix::of_rows(p.Js.data(), p.contact_rows, n);
  d.Js_bias = Matrix::vector(p.Js_bias.data(), p.contact_rows);
  int first = 0;
  for (int k = 0; k < p.levels; ++k) {
    const int rows = p.level_end[static_cast<std::size_t>(k)] - first;
    NaiveLevel level;
    level.J = Matrix::of_rows(p.J.data() + first * n, rows, n);
    level.J_bias = Matrix::vector(p.J_bias.data() + first, rows);
    level.u = Matrix::vector(p.u.data() + first, rows);
    for (int i = 0; i < rows; ++i) {
      const double w = std::sqrt(p.weight[static_cast<std::size_t>(first + i)]);
      level.J.set_row(i, w * level.J.row(i));
      level.J_bias(i) *= w;
      level.u(i) *= w;
    }
    d.levels.push_back(level);
    first += rows;
  }
  // F_r = -f: a row on the ground's force changes its sign.
  d.W_int = -Matrix::of_rows(p.W_int.data(), p.internal_rows, p.contact_rows);
  d.F_int = Matrix::vector(p.F_int.data(), p.internal_rows);
  d.K_F = Matrix::vector(p.K_F.data(), p.internal_rows);
  if (p.tau_measured) d.tau_measured = Matrix::vector(p.tau_measured, na);
  return d;
}

}  // namespace footfall::tests
