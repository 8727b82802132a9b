// Whole-body operational space control as pure algebra: from the factored mass matrix, contact and
// task Jacobians and desired task accelerations to joint torques. The last computation of a tick.
//
//   τ = Σ_k J*ₖᵀ Λ*ₖ (uₖ - J̇ₖq̇ + …)
//       + L*ᵀ J*_ilᵀ (F_ref - F_task + K_F (F_ref - F_meas) + K_I ∫(F_ref - F_meas) dt)
//
// Source: [Kim16] Appendix A, eqs. (28)-(44), with the corrections E6, E7, E10-E13 of
// docs/notation.md. Implemented in reduced coordinates: with A = LᵀDL and W = D^-1/2 L^-T [...],
// a QR of W_c = W J_sᵀ splits acceleration into a constrained part (Q₁) and a free part (Q₂);
// B = Q₂ᵀ W Uᵀ is the whole actuated, constrained dynamics: BᵀB = φ = U N_s A⁻¹ (U N_s)ᵀ. A pivoted
// QR of B gives its range (tasks), rank and null space (internal forces); each priority level is a
// pivoted QR in what its predecessors left. Contact forces and torques equal Appendix A's.
#pragma once

#include <span>
#include <vector>

#include "model/tree_factor.h"
#include "tasks/solver/dense_kernels.h"

namespace footfall::tasks {

// Worst-case sizes; memory is allocated once.
struct WboscSizes {
  int nv = 0;  // generalised velocities
  int na = 0;  // actuated ones
  int contact_rows = 0;
  int task_rows = 0;
  int levels = 0;
  int internal_rows = 0;
};

struct WboscOptions {
  // A direction counts as lost when what is left of its column is below this part of the column's
  // own norm before projection (sizes are those of the kinetic-energy metric). It lies far above
  // round-off (1e-16 x condition) and far below the smallest physical ratio met on bipeds (0.05).
  double rank_tolerance = 1e-6;
  // The same of internal forces. Its inverse is how many newtons of other internal forces one
  // newton may cost: the six tensions of four feet in a plane are five, and on ground that is
  // nearly plane the sixth must not be made of the vertical forces.
  double internal_rank_tolerance = 0.1;
  // Absolute floor on the same norms: a row that is zero has no rank at all.
  double absolute_floor = 1e-10;
};

// What to solve; the caller fills the used parts in place. Row-major.
struct WboscProblem {
  model::TreeFactor factor;
  const double* bias = nullptr;          // b + g, nv
  const int* actuated = nullptr;         // na, generalised index of each actuator
  const double* torque_limit = nullptr;  // na, N m; nullptr: none
  int contact_rows = 0;
  int task_rows = 0;
  int levels = 0;
  int internal_rows = 0;
  int named_internal_rows = 0;   // the first ones are met before the rest
  std::vector<double> Js;        // contact_rows x nv
  std::vector<double> Js_bias;   // J̇_s q̇
  std::vector<double> J;         // task_rows x nv, levels one after the other
  std::vector<double> J_bias;    // J̇ q̇
  std::vector<double> u;         // commanded task acceleration
  std::vector<double> weight;    // of a row's residual where its level is over-determined; not
                                 // above 0: the row is no part of its level
  std::vector<int> level_end;    // levels: one past the last row of each
  std::vector<double> external;  // nv: known generalised force (0 unless set), e.g. Jᵀf of a foot
  std::vector<double> W_int;     // internal_rows x contact_rows, acts on f (ground on robot)
  std::vector<double> F_int;     // wanted W_int f
  std::vector<double> K_F;       // feedback on W_int f(tau_measured), 0: none
  // What is fed back is this part of the error, F_int of the tick before - W_int f(tau_measured),
  // whose torque was asked for then, after a low-pass: before + share (... - before); share 1:
  // none.
  std::vector<double> F_before, error_part, error_share, error_before;
  // Integral of that error: before + gain error, within limit (negative: none). It does not grow
  // while a torque limit acts (hold_integral); without a gain it fades with the low-pass.
  std::vector<double> integral_gain, integral_before, integral_limit;
  bool hold_integral = false;
  const double* tau_measured = nullptr;  // na; nullptr: no feedback
};

// The one place that says what a limit does to a torque, N m.
inline double within_limit(double tau, double limit) noexcept {
  return tau > limit ? limit : tau < -limit ? -limit : tau;
}

struct WboscSolution {
  std::vector<double> asked;     // na, N m, before limits; not finite if `finite` is false
  std::vector<double> tau;       // na, within limits: all below is under this torque
  std::vector<double> f;         // contact_rows: ground on robot, as the control law predicts it
  std::vector<double> achieved;  // task_rows: J q̈ + J̇ q̇ under tau
  std::vector<double> internal;  // internal_rows: W_int f under tau
  std::vector<double> internal_measured;  // internal_rows: W_int f under tau_measured
  std::vector<double> internal_error;     // internal_rows: what is fed back, N
  std::vector<double> internal_integral;  // internal_rows: N
  std::vector<double> f_measured;  // contact_rows: ground on robot under tau_measured, else f
  int internal_rank = 0;           // of the rows of internal forces
  int named_internal_rank = 0;     // of the named ones
  std::vector<int> level_rows;     // levels: rows of a weight above 0
  std::vector<int> level_rank;     // levels
  // levels: the longest row of all levels over the smallest pivot that this level keeps (whitened
  // rows); 1 without rows
  std::vector<double> level_condition;
  int contact_rank = 0;
  int actuation_rank = 0;  // of φ; na - rank internal-force directions
  bool limited = false;    // a torque limit acted
  bool finite = true;      // false: a torque asked for is not a number
};

class Wbosc {
 public:
  explicit Wbosc(const WboscSizes& sizes, const WboscOptions& options = {});

  WboscProblem& problem() noexcept { return problem_; }
  const WboscSolution& solution() const noexcept { return solution_; }
  // Of an internal force, as solved: N.
  double reference(int row) const noexcept { return problem_.F_int[static_cast<std::size_t>(row)]; }

  // Solves problem(). Allocates nothing; cost depends on the sizes only.
  void solve() noexcept;

 private:
  void gather() noexcept;
  void order_task_rows() noexcept;
  void reduce_contacts() noexcept;
  void reduce_redundant_contacts() noexcept;
  void reduce_actuation() noexcept;
  void solve_levels() noexcept;
  void solve_level(int level, int first, int last) noexcept;
  void torque_from_range() noexcept;
  void add_internal_forces() noexcept;
  void feed_back(int row, double measured) noexcept;
  void add_null_torque(int nulls, int rows) noexcept;
  void finish() noexcept;
  void contact_forces(const double* tau, double* f) noexcept;
  Reflectors actuation_rotation() noexcept;
  Reflectors contact_rotation() noexcept;
  double* row(int r) noexcept { return x_.data() + r * stride_; }
  const double* row(int r) const noexcept { return x_.data() + r * stride_; }

  WboscSizes sizes_;
  WboscOptions options_;
  WboscProblem problem_;
  WboscSolution solution_;

  // X = [J_sᵀ | Uᵀ | Jᵀ | h], nv rows, whitened and then rotated in place.
  std::vector<double> x_;
  int stride_ = 0;
  int col_u_ = 0, col_t_ = 0, col_h_ = 0, columns_ = 0;

  double longest_row_ = 0.0;          // of the tasks, after whitening
  std::vector<double> column_norm2_;  // squared, after whitening: the yardstick of every rank
  std::vector<int> contact_order_, actuator_order_, level_order_;
  std::vector<double> a1_;  // constrained acceleration, contact_rank
  std::vector<double> z_;   // free acceleration in the rotated range of B
  std::vector<double> rhs_, y_;
  std::vector<double> free_bias_;  // J̇q̇ + T₁ᵀa₁ - T₂ᵀh₂: task acceleration without torque
  std::vector<double> reflectors_;  // of the levels, one row of nv each
  std::vector<double> reflector_beta_;
  int level_reflectors_ = 0;
  std::vector<double> null_reflectors_, null_beta_;  // of the internal forces
  // Complete factors where rank is lost, [R11 R12]ᵀ = V [T; 0], V as reflections: of B (its row
  // space, then its null space) and of redundant contacts.
  std::vector<double> V_, V_beta_, T_;
  std::vector<double> Vc_, Vc_beta_, Tc_;
  std::vector<double> N_;  // na - rank null vectors of B, one after the other
  std::vector<double> G_;  // null space x internal rows
  std::vector<double> alpha_;
  std::vector<double> internal_norm2_, internal_weight_, forces_;
  std::vector<int> internal_order_;
  std::vector<double> work_;
  int level_rank_sum_ = 0;
};

}  // namespace footfall::tasks
