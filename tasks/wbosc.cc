// Reduced WBOSC; see wbosc.h for the law and the idea.
#include "tasks/wbosc.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "tasks/dense_kernels.h"

namespace footfall::tasks {
namespace {

std::size_t size(int n) { return static_cast<std::size_t>(std::max(n, 0)); }

// Σ_r x(r, a) x(r, b) over rows [first, last).
double column_dot(const Block& x, int first, int last, int a, int b) noexcept {
  double sum = 0.0;
  for (int r = first; r < last; ++r) sum += x.row(r)[a] * x.row(r)[b];
  return sum;
}

}  // namespace

Wbosc::Wbosc(const WboscSizes& sizes, const WboscOptions& options)
    : sizes_(sizes), options_(options) {
  const int n = sizes.nv;
  const int columns = sizes.contact_rows + sizes.na + sizes.task_rows + 1;
  stride_ = (columns + 1) & ~1;
  x_.assign(size(n * stride_), 0.0);
  problem_.Js.assign(size(sizes.contact_rows * n), 0.0);
  problem_.Js_bias.assign(size(sizes.contact_rows), 0.0);
  problem_.J.assign(size(sizes.task_rows * n), 0.0);
  problem_.J_bias.assign(size(sizes.task_rows), 0.0);
  problem_.u.assign(size(sizes.task_rows), 0.0);
  problem_.weight.assign(size(sizes.task_rows), 1.0);
  problem_.level_end.assign(size(sizes.levels), 0);
  problem_.external.assign(size(n), 0.0);
  problem_.W_int.assign(size(sizes.internal_rows * sizes.contact_rows), 0.0);
  problem_.F_int.assign(size(sizes.internal_rows), 0.0);
  problem_.K_F.assign(size(sizes.internal_rows), 0.0);
  solution_.tau.assign(size(sizes.na), 0.0);
  solution_.f.assign(size(sizes.contact_rows), 0.0);
  solution_.achieved.assign(size(sizes.task_rows), 0.0);
  solution_.internal.assign(size(sizes.internal_rows), 0.0);
  solution_.internal_measured.assign(size(sizes.internal_rows), 0.0);
  solution_.level_rank.assign(size(sizes.levels), 0);
  solution_.level_condition.assign(size(sizes.levels), 1.0);
  column_norm2_.assign(size(columns), 0.0);
  contact_order_.assign(size(columns), 0);
  actuator_order_.assign(size(columns), 0);
  level_order_.assign(size(columns), 0);
  a1_.assign(size(sizes.contact_rows), 0.0);
  z_.assign(size(2 * n), 0.0);
  rhs_.assign(size(std::max(sizes.task_rows, sizes.internal_rows)), 0.0);
  y_.assign(size(std::max({n, sizes.task_rows, sizes.contact_rows, sizes.internal_rows})), 0.0);
  free_bias_.assign(size(sizes.task_rows), 0.0);
  reflectors_.assign(size(n * n), 0.0);
  reflector_beta_.assign(size(n), 0.0);
  null_reflectors_.assign(size(sizes.na * sizes.na), 0.0);
  null_beta_.assign(size(sizes.na), 0.0);
  V_.assign(size(sizes.na * sizes.na), 0.0);
  T_.assign(size(sizes.na * sizes.na), 0.0);
  Cz_.assign(size(sizes.contact_rows * sizes.contact_rows), 0.0);
  Ct_.assign(size(sizes.contact_rows * n), 0.0);
  G_.assign(size(sizes.na * sizes.internal_rows), 0.0);
  alpha_.assign(size(sizes.na), 0.0);
  internal_norm2_.assign(size(sizes.internal_rows), 0.0);
  internal_weight_.assign(size(sizes.internal_rows), 1.0);
  internal_order_.assign(size(sizes.internal_rows), 0);
  forces_.assign(size(2 * sizes.contact_rows + sizes.na), 0.0);
  const int rows = std::max(sizes.task_rows, sizes.internal_rows);
  work_.assign(size(rows * (n + 2) + 4 * (stride_ + n + rows + sizes.contact_rows)), 0.0);
}

void Wbosc::solve() noexcept {
  gather();
  reduce_contacts();
  reduce_actuation();
  solve_levels();
  torque_from_range();
  add_internal_forces();
  finish();
}

// X = [J_sᵀ | Uᵀ | Jᵀ | h] with h = b + g - known external forces, then whitened.
void Wbosc::gather() noexcept {
  const WboscProblem& p = problem_;
  const int n = sizes_.nv;
  const int na = sizes_.na;
  col_u_ = p.contact_rows;
  col_t_ = col_u_ + na;
  col_h_ = col_t_ + p.task_rows;
  columns_ = col_h_ + 1;
  for (int r = 0; r < n; ++r) {
    double* x = row(r);
    for (int c = 0; c < p.contact_rows; ++c) x[c] = p.Js[size(c * n + r)];
    std::fill(x + col_u_, x + col_t_, 0.0);
    for (int c = 0; c < p.task_rows; ++c) x[col_t_ + c] = p.J[size(c * n + r)];
    x[col_h_] = p.bias[r] - p.external[size(r)];
  }
  for (int j = 0; j < na; ++j) row(p.actuated[j])[col_u_ + j] = 1.0;
  model::whiten(p.factor, x_.data(), columns_, stride_);
  std::fill_n(column_norm2_.data(), columns_, 0.0);
  for (int r = 0; r < n; ++r) {
    const double* x = row(r);
    for (int c = 0; c < columns_; ++c) column_norm2_[size(c)] += x[c] * x[c];
  }
  for (int c = 0; c < columns_; ++c) {
    contact_order_[size(c)] = c;
    actuator_order_[size(c)] = c - col_u_;
    level_order_[size(c)] = c - col_t_;
  }
  level_reflectors_ = 0;
}

// W_c P = Q [R; 0]; the constraint J_s q̈ + J̇_s q̇ = 0 fixes a₁ = -R⁻ᵀ Pᵀ J̇_s q̇.
void Wbosc::reduce_contacts() noexcept {
  const Block x = {x_.data(), stride_};
  const RankRule rule = {options_.rank_tolerance, options_.absolute_floor};
  const QrRange range = {0, sizes_.nv, 0, problem_.contact_rows, columns_, sizes_.nv};
  const int k = pivoted_qr(x, range, rule, contact_order_.data(), column_norm2_.data(), nullptr,
                           nullptr, work_.data());
  solution_.contact_rank = k;
  if (k == problem_.contact_rows) {
    for (int i = 0; i < k; ++i) {
      double value = -problem_.Js_bias[size(contact_order_[size(i)])];
      for (int q = 0; q < i; ++q) value -= x.row(q)[i] * a1_[size(q)];
      a1_[size(i)] = value / x.row(i)[i];
    }
  } else {
    reduce_redundant_contacts();
  }
}

// Redundant contacts: [R11 R12]ᵀ = V [T; 0], so that forces can be shared with least norm. A moving
// link cannot keep all its points unaccelerated: a₁ = T⁻¹ V₁ᵀ (-Pᵀ J̇_s q̇) comes nearest.
void Wbosc::reduce_redundant_contacts() noexcept {
  const int k = solution_.contact_rank;
  const int nc = problem_.contact_rows;
  const Block t = {Ct_.data(), std::max(k, 1)};
  for (int i = 0; i < nc; ++i) {
    for (int q = 0; q < k; ++q) t.row(i)[q] = row(q)[i];
  }
  orthogonal_factor(t, nc, k, Cz_.data(), work_.data());
  for (int i = k - 1; i >= 0; --i) {
    double value = 0.0;
    for (int c = 0; c < nc; ++c) {
      value -= Cz_[size(c * nc + i)] * problem_.Js_bias[size(contact_order_[size(c)])];
    }
    for (int q = i + 1; q < k; ++q) value -= t.row(i)[q] * a1_[size(q)];
    a1_[size(i)] = value / t.row(i)[i];
  }
}

// B P = Z [R11 R12]; its rank is φ's. Rank-deficient: [R11 R12]ᵀ = V [T; 0], V₂ spans L*.
void Wbosc::reduce_actuation() noexcept {
  const Block x = {x_.data(), stride_};
  const RankRule rule = {options_.rank_tolerance, options_.absolute_floor};
  const int k = solution_.contact_rank;
  const int na = sizes_.na;
  const QrRange range = {k, sizes_.nv, col_u_, col_t_, columns_, sizes_.nv};
  const int r = pivoted_qr(x, range, rule, actuator_order_.data(), column_norm2_.data(), nullptr,
                           nullptr, work_.data());
  solution_.actuation_rank = r;
  if (r == na) return;
  const Block t = {T_.data(), std::max(r, 1)};
  for (int j = 0; j < na; ++j) {
    for (int q = 0; q < r; ++q) t.row(j)[q] = x.row(k + q)[col_u_ + j];
  }
  orthogonal_factor(t, na, r, V_.data(), work_.data());
}

// rhs = u - J̇q̇ - T₁ᵀ a₁ + T₂ᵀ h₂, then one cascade over the levels in the range of B.
void Wbosc::solve_levels() noexcept {
  const Block x = {x_.data(), stride_};
  const int k = solution_.contact_rank;
  for (int i = 0; i < problem_.task_rows; ++i) {
    double value = problem_.J_bias[size(i)];
    for (int q = 0; q < k; ++q) value += x.row(q)[col_t_ + i] * a1_[size(q)];
    value -= column_dot(x, k, sizes_.nv, col_t_ + i, col_h_);
    free_bias_[size(i)] = value;
    rhs_[size(i)] = problem_.u[size(i)] - value;
  }
  level_rank_sum_ = 0;
  std::fill_n(z_.data(), sizes_.nv, 0.0);
  int first = 0;
  for (int level = 0; level < problem_.levels; ++level) {
    solve_level(level, first, problem_.level_end[size(level)]);
    first = problem_.level_end[size(level)];
  }
}

void Wbosc::solve_level(int level, int first, int last) noexcept {
  const Block x = {x_.data(), stride_};
  const RankRule rule = {options_.rank_tolerance, options_.absolute_floor};
  Reflectors keep = {reflectors_.data(), reflector_beta_.data(), sizes_.nv, level_reflectors_};
  const LevelRange range = {solution_.contact_rank, solution_.actuation_rank, level_rank_sum_,
                            col_t_ + first,         col_t_ + last,            col_h_,
                            sizes_.nv};
  double* dense = work_.data() + 2 * (stride_ + sizes_.nv + sizes_.task_rows);
  const LevelScratch scratch = {y_.data(), dense, work_.data()};
  const int rank = solve_cascade_level(x, range, rule, level_order_.data(), column_norm2_.data(),
                                       rhs_.data(), problem_.weight.data(), z_.data(), &keep,
                                       &solution_.level_condition[size(level)], scratch);
  level_reflectors_ = keep.count;
  solution_.level_rank[size(level)] = rank;
  level_rank_sum_ += rank;
}

// c = Z Q_levels z is the free acceleration asked for; τ = B⁺ c, the torque of least norm.
void Wbosc::torque_from_range() noexcept {
  const int k = solution_.contact_rank;
  const int r = solution_.actuation_rank;
  const int na = sizes_.na;
  double* c = z_.data() + sizes_.nv;
  std::copy_n(z_.data(), r, c);
  rotate_back({reflectors_.data(), reflector_beta_.data(), sizes_.nv, level_reflectors_}, r, c);
  double* tau_p = work_.data();
  if (r == na) {
    for (int i = na - 1; i >= 0; --i) {
      double value = c[i];
      for (int q = i + 1; q < na; ++q) value -= row(k + i)[col_u_ + q] * tau_p[q];
      tau_p[i] = value / row(k + i)[col_u_ + i];
    }
  } else {
    double* y = tau_p + na;
    for (int i = 0; i < r; ++i) {  // Tᵀ y = c
      double value = c[i];
      for (int q = 0; q < i; ++q) value -= T_[size(q * r + i)] * y[q];
      y[i] = value / T_[size(i * r + i)];
    }
    for (int j = 0; j < na; ++j) {
      double value = 0.0;
      for (int q = 0; q < r; ++q) value += V_[size(j * na + q)] * y[q];
      tau_p[j] = value;
    }
  }
  for (int j = 0; j < na; ++j) {
    solution_.tau[size(actuator_order_[size(col_u_ + j)])] = tau_p[j];
  }
}

// f = R⁻¹ (a₁ - B₁ τ + h₁): ground on robot; of least norm where contacts are redundant.
void Wbosc::contact_forces(const double* tau, double* f) noexcept {
  const int k = solution_.contact_rank;
  const int nc = problem_.contact_rows;
  double* y = work_.data() + 2 * sizes_.na;
  double* fp = y + nc + k;
  for (int i = 0; i < k; ++i) {
    const double* x = row(i);
    double value = a1_[size(i)] + x[col_h_];
    for (int j = 0; j < sizes_.na; ++j) {
      value -= x[col_u_ + j] * tau[actuator_order_[size(col_u_ + j)]];
    }
    y[i] = value;
  }
  if (k == nc) {
    for (int i = k - 1; i >= 0; --i) {
      double value = y[i];
      for (int q = i + 1; q < k; ++q) value -= row(i)[q] * fp[q];
      fp[i] = value / row(i)[i];
    }
  } else {
    for (int i = 0; i < k; ++i) {  // Tᵀ s = y
      double value = y[i];
      for (int q = 0; q < i; ++q) value -= Ct_[size(q * k + i)] * y[q];
      y[i] = value / Ct_[size(i * k + i)];
    }
    for (int i = 0; i < nc; ++i) {
      double value = 0.0;
      for (int q = 0; q < k; ++q) value += Cz_[size(i * nc + q)] * y[q];
      fp[i] = value;
    }
  }
  for (int i = 0; i < nc; ++i) f[contact_order_[size(i)]] = fp[i];
}

// In the null space of B torques only change contact forces: W_int f(τ + N α) = F_int, named rows
// first, the others in what those left.
void Wbosc::add_internal_forces() noexcept {
  const int na = sizes_.na;
  const int nc = problem_.contact_rows;
  const int r = solution_.actuation_rank;
  const int nulls = na - r;
  const int rows = problem_.internal_rows;
  if (rows == 0) return;
  double* f0 = forces_.data();
  double* f1 = f0 + nc;
  double* probe = f1 + nc;
  contact_forces(solution_.tau.data(), f0);
  std::fill_n(internal_norm2_.data(), rows, 0.0);
  for (int q = 0; q < nulls; ++q) {  // column q of G = W_int ∂f/∂α_q, stored transposed
    for (int j = 0; j < na; ++j) {
      const int actuator = actuator_order_[size(col_u_ + j)];
      probe[actuator] = solution_.tau[size(actuator)] + V_[size(j * na + r + q)];
    }
    contact_forces(probe, f1);
    for (int i = 0; i < rows; ++i) {
      double value = 0.0;
      for (int c = 0; c < nc; ++c) value += problem_.W_int[size(i * nc + c)] * (f1[c] - f0[c]);
      G_[size(q * rows + i)] = value;
      internal_norm2_[size(i)] += value * value;
    }
  }
  if (problem_.tau_measured) contact_forces(problem_.tau_measured, f1);
  for (int i = 0; i < rows; ++i) {
    double now = 0.0;
    double measured = 0.0;
    for (int c = 0; c < nc; ++c) {
      now += problem_.W_int[size(i * nc + c)] * f0[c];
      measured += problem_.W_int[size(i * nc + c)] * f1[c];
    }
    double wanted = problem_.F_int[size(i)];
    if (problem_.tau_measured) wanted += problem_.K_F[size(i)] * (wanted - measured);
    solution_.internal_measured[size(i)] = problem_.tau_measured ? measured : now;
    rhs_[size(i)] = wanted - now;
    internal_order_[size(i)] = i;
  }
  if (nulls > 0) add_null_torque(nulls, rows);
}

// Solves Gᵀ's two-level cascade for α and adds N α to the torque.
void Wbosc::add_null_torque(int nulls, int rows) noexcept {
  const int na = sizes_.na;
  const int r = solution_.actuation_rank;
  const Block g = {G_.data(), rows};
  const RankRule rule = {options_.rank_tolerance, options_.absolute_floor};
  Reflectors keep = {null_reflectors_.data(), null_beta_.data(), na, 0};
  const LevelScratch scratch = {y_.data(), work_.data() + 2 * (stride_ + sizes_.nv + rows),
                                work_.data()};
  std::fill_n(alpha_.data(), nulls, 0.0);
  int done = 0;
  const std::array<int, 3> ends = {0, std::min(problem_.named_internal_rows, rows), rows};
  for (std::size_t level = 1; level < ends.size(); ++level) {
    if (ends[level] == ends[level - 1]) continue;
    const LevelRange range = {0, nulls, done, ends[level - 1], ends[level], rows, nulls};
    done += solve_cascade_level(g, range, rule, internal_order_.data(), internal_norm2_.data(),
                                rhs_.data(), internal_weight_.data(), alpha_.data(), &keep, nullptr,
                                scratch);
  }
  rotate_back(keep, nulls, alpha_.data());
  for (int j = 0; j < na; ++j) {
    double value = 0.0;
    for (int q = 0; q < nulls; ++q) value += V_[size(j * na + r + q)] * alpha_[size(q)];
    solution_.tau[size(actuator_order_[size(col_u_ + j)])] += value;
  }
}

// Limits, then what this torque does: forces, internal forces, task accelerations.
void Wbosc::finish() noexcept {
  const int na = sizes_.na;
  const int k = solution_.contact_rank;
  const int r = solution_.actuation_rank;
  double* tau = solution_.tau.data();
  solution_.finite = true;
  solution_.limited = false;
  for (int j = 0; j < na; ++j) {
    if (!std::isfinite(tau[j])) solution_.finite = false;
    if (!problem_.torque_limit) continue;
    const double limited =
        std::clamp(tau[j], -problem_.torque_limit[j], problem_.torque_limit[j]);
    solution_.limited |= limited != tau[j];
    tau[j] = limited;
  }
  if (!solution_.finite) std::fill_n(tau, na, 0.0);
  contact_forces(tau, solution_.f.data());
  for (int i = 0; i < problem_.internal_rows; ++i) {
    double value = 0.0;
    for (int c = 0; c < problem_.contact_rows; ++c) {
      value += problem_.W_int[size(i * problem_.contact_rows + c)] * solution_.f[size(c)];
    }
    solution_.internal[size(i)] = value;
  }
  double* c = z_.data() + sizes_.nv;  // Zᵀ B τ, then in the levels' coordinates
  for (int i = 0; i < r; ++i) {
    double value = 0.0;
    for (int j = i; j < na; ++j) {
      value += row(k + i)[col_u_ + j] * tau[actuator_order_[size(col_u_ + j)]];
    }
    c[i] = value;
  }
  rotate({reflectors_.data(), reflector_beta_.data(), sizes_.nv, level_reflectors_}, r, c);
  for (int t = 0; t < problem_.task_rows; ++t) {
    const int original = level_order_[size(col_t_ + t)];
    double value = free_bias_[size(original)];
    for (int q = 0; q < r; ++q) value += row(k + q)[col_t_ + t] * c[q];
    solution_.achieved[size(original)] = value;
  }
}

// Gram matrix of J* in the metric of φ: rows of T in the range of B, whatever their rotation.
void Wbosc::effective_inertia(int first, int last, double* lambda) const {
  const int m = last - first;
  const int k = solution_.contact_rank;
  const int r = solution_.actuation_rank;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(m, m);
  for (int a = 0; a < problem_.task_rows; ++a) {
    const int i = level_order_[size(col_t_ + a)] - first;
    if (i < 0 || i >= m) continue;
    for (int b = 0; b < problem_.task_rows; ++b) {
      const int j = level_order_[size(col_t_ + b)] - first;
      if (j < 0 || j >= m) continue;
      for (int q = 0; q < r; ++q) gram(i, j) += row(k + q)[col_t_ + a] * row(k + q)[col_t_ + b];
    }
  }
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> cod(gram);
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(lambda, m, m) =
      cod.pseudoInverse();
}

}  // namespace footfall::tasks
