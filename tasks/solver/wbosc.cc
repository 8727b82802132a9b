// Reduced WBOSC; see wbosc.h for the law and the idea.
#include "tasks/solver/wbosc.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace footfall::tasks {
namespace {

// A row of a matrix into a column of a row-major block.
void scatter(int n, const double* __restrict from, double* __restrict to, int stride) noexcept {
  for (int i = 0; i < n; ++i, to += stride) *to = from[i];
}

// to += s from.
void add_scaled(int n, double s, const double* __restrict from, double* __restrict to) noexcept {
  for (int i = 0; i < n; ++i) to[i] += s * from[i];
}

}  // namespace

Wbosc::Wbosc(const WboscSizes& sizes, const WboscOptions& options)
    : sizes_(sizes), options_(options) {
  const int n = sizes.nv;
  const int columns = sizes.contact_rows + sizes.na + sizes.task_rows + 1;
  stride_ = (columns + 1) & ~1;
  x_.assign(extent(n * stride_), 0.0);
  problem_.Js.assign(extent(sizes.contact_rows * n), 0.0);
  problem_.Js_bias.assign(extent(sizes.contact_rows), 0.0);
  problem_.J.assign(extent(sizes.task_rows * n), 0.0);
  problem_.J_bias.assign(extent(sizes.task_rows), 0.0);
  problem_.u.assign(extent(sizes.task_rows), 0.0);
  problem_.weight.assign(extent(sizes.task_rows), 1.0);
  problem_.level_end.assign(extent(sizes.levels), 0);
  problem_.external.assign(extent(n), 0.0);
  problem_.W_int.assign(extent(sizes.internal_rows * sizes.contact_rows), 0.0);
  for (std::vector<double>* rows :
       {&problem_.F_int, &problem_.K_F, &problem_.F_before, &problem_.error_before,
        &problem_.integral_gain, &problem_.integral_before, &solution_.internal,
        &solution_.internal_measured, &solution_.internal_error, &solution_.internal_integral}) {
    rows->assign(extent(sizes.internal_rows), 0.0);
  }
  problem_.error_share.assign(extent(sizes.internal_rows), 1.0);
  problem_.error_part.assign(extent(sizes.internal_rows), 1.0);
  problem_.integral_limit.assign(extent(sizes.internal_rows), -1.0);
  solution_.asked.assign(extent(sizes.na), 0.0);
  solution_.tau.assign(extent(sizes.na), 0.0);
  solution_.f.assign(extent(sizes.contact_rows), 0.0);
  solution_.achieved.assign(extent(sizes.task_rows), 0.0);
  solution_.f_measured.assign(extent(sizes.contact_rows), 0.0);
  solution_.level_rows.assign(extent(sizes.levels), 0);
  solution_.level_rank.assign(extent(sizes.levels), 0);
  solution_.level_condition.assign(extent(sizes.levels), 1.0);
  column_norm2_.assign(extent(stride_), 0.0);
  contact_order_.assign(extent(columns), 0);
  actuator_order_.assign(extent(columns), 0);
  level_order_.assign(extent(columns), 0);
  a1_.assign(extent(sizes.contact_rows), 0.0);
  z_.assign(extent(2 * n), 0.0);
  rhs_.assign(extent(std::max(sizes.task_rows, sizes.internal_rows)), 0.0);
  y_.assign(extent(std::max({n, sizes.task_rows, sizes.contact_rows, sizes.internal_rows})), 0.0);
  free_bias_.assign(extent(sizes.task_rows), 0.0);
  reflectors_.assign(extent(n * n), 0.0);
  reflector_beta_.assign(extent(n), 0.0);
  for (auto* square : {&null_reflectors_, &V_, &T_, &N_}) {
    square->assign(extent(sizes.na * sizes.na), 0.0);
  }
  null_beta_.assign(extent(sizes.na), 0.0);
  V_beta_.assign(extent(sizes.na), 0.0);
  Vc_.assign(extent(sizes.contact_rows * n), 0.0);
  Vc_beta_.assign(extent(n), 0.0);
  Tc_.assign(extent(sizes.contact_rows * n), 0.0);
  G_.assign(extent(sizes.na * sizes.internal_rows), 0.0);
  alpha_.assign(extent(sizes.na), 0.0);
  internal_norm2_.assign(extent(sizes.internal_rows), 0.0);
  internal_weight_.assign(extent(sizes.internal_rows), 1.0);
  internal_order_.assign(extent(sizes.internal_rows), 0);
  forces_.assign(extent(2 * sizes.contact_rows + sizes.na), 0.0);
  const int rows = std::max(sizes.task_rows, sizes.internal_rows);
  work_.assign(extent(rows * (n + 2) + 4 * (stride_ + n + rows + sizes.contact_rows)), 0.0);
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

// Columns of Jᵀ: the rows of each level, then those of no weight, which are no part of their level
// and only carried along.
void Wbosc::order_task_rows() noexcept {
  const WboscProblem& p = problem_;
  int* order = level_order_.data() + col_t_;
  int column = 0;
  int first = 0;
  for (int level = 0; level < p.levels; ++level) {
    const int before = column;
    for (int r = first; r < p.level_end[extent(level)]; ++r) {
      if (p.weight[extent(r)] > 0.0) order[column++] = r;
    }
    solution_.level_rows[extent(level)] = column - before;
    first = p.level_end[extent(level)];
  }
  for (int r = 0; r < p.task_rows; ++r) {
    if (!(p.weight[extent(r)] > 0.0)) order[column++] = r;
  }
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
  const double* Js = p.Js.data();
  const double* J = p.J.data();
  for (int c = 0; c < p.contact_rows; ++c) scatter(n, Js + c * n, x_.data() + c, stride_);
  order_task_rows();
  for (int c = col_t_; c < col_h_; ++c) {
    scatter(n, J + level_order_[extent(c)] * n, x_.data() + c, stride_);
  }
  for (int r = 0; r < n; ++r) {
    double* x = row(r);
    for (int j = col_u_; j < col_t_; ++j) x[j] = 0.0;
    x[col_h_] = p.bias[r] - p.external[extent(r)];
  }
  for (int j = 0; j < na; ++j) row(p.actuated[j])[col_u_ + j] = 1.0;
  model::whiten(p.factor, x_.data(), columns_, stride_);
  double* norm2 = column_norm2_.data();
  for (int c = 0; c < columns_; c += 2) {  // the block and this array have an even size
    model::DoublePair sum = {};
    const double* x = x_.data() + c;
    for (int r = 0; r < n; ++r, x += stride_) {
      const auto v = *reinterpret_cast<const model::DoublePair*>(x);
      sum += v * v;
    }
    *reinterpret_cast<model::DoublePair*>(norm2 + c) = sum;
  }
  int weighted = 0;  // rows of weight 0 stand behind the others and are no part of a level
  for (int level = 0; level < p.levels; ++level) weighted += solution_.level_rows[extent(level)];
  double longest2 = 0.0;
  for (int c = col_t_; c < col_t_ + weighted; ++c) longest2 = std::max(longest2, norm2[c]);
  longest_row_ = std::sqrt(longest2);
  for (int c = 0; c < columns_; ++c) {
    contact_order_[extent(c)] = c;
    actuator_order_[extent(c)] = c - col_u_;
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
      double value = -problem_.Js_bias[extent(contact_order_[extent(i)])];
      for (int q = 0; q < i; ++q) value -= x.row(q)[i] * a1_[extent(q)];
      a1_[extent(i)] = value / x.row(i)[i];
    }
  } else {
    reduce_redundant_contacts();
  }
}

Reflectors Wbosc::contact_rotation() noexcept {
  return {Vc_.data(), Vc_beta_.data(), sizes_.contact_rows, solution_.contact_rank};
}

Reflectors Wbosc::actuation_rotation() noexcept {
  return {V_.data(), V_beta_.data(), sizes_.na, solution_.actuation_rank};
}

// Redundant contacts: [R11 R12]ᵀ = V [T; 0], so that forces can be shared with least norm. A moving
// link cannot keep all its points unaccelerated: a₁ = T⁻¹ V₁ᵀ (-Pᵀ J̇_s q̇) comes nearest.
void Wbosc::reduce_redundant_contacts() noexcept {
  const int k = solution_.contact_rank;
  const int nc = problem_.contact_rows;
  const Block t = {Tc_.data(), std::max(k, 1)};
  for (int i = 0; i < nc; ++i) {
    for (int q = 0; q < k; ++q) t.row(i)[q] = row(q)[i];
  }
  Reflectors keep = {Vc_.data(), Vc_beta_.data(), sizes_.contact_rows, 0};
  orthogonal_factor(t, nc, k, &keep);
  double* wanted = work_.data();
  for (int c = 0; c < nc; ++c) wanted[c] = -problem_.Js_bias[extent(contact_order_[extent(c)])];
  rotate(keep, nc, wanted);
  for (int i = k - 1; i >= 0; --i) {
    double value = wanted[i];
    for (int q = i + 1; q < k; ++q) value -= t.row(i)[q] * a1_[extent(q)];
    a1_[extent(i)] = value / t.row(i)[i];
  }
}

// B P = Z [R11 R12]; its rank is φ's. Rank-deficient: [R11 R12]ᵀ = V [T; 0], N = V₂ spans L*.
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
  Reflectors keep = {V_.data(), V_beta_.data(), na, 0};
  orthogonal_factor(t, na, r, &keep);
  for (int q = 0; q < na - r; ++q) {
    double* null_vector = N_.data() + q * na;
    std::fill_n(null_vector, na, 0.0);
    null_vector[r + q] = 1.0;
    rotate_back(keep, na, null_vector);
  }
}

// rhs = u - J̇q̇ - T₁ᵀ a₁ + T₂ᵀ h₂, then one cascade over the levels in the range of B.
void Wbosc::solve_levels() noexcept {
  const int k = solution_.contact_rank;
  const int rows = problem_.task_rows;
  const int* order = level_order_.data() + col_t_;
  for (int c = 0; c < rows; ++c) y_[extent(c)] = problem_.J_bias[extent(order[c])];
  for (int q = 0; q < sizes_.nv; ++q) {
    const double share = q < k ? a1_[extent(q)] : -row(q)[col_h_];
    add_scaled(rows, share, row(q) + col_t_, y_.data());
  }
  for (int c = 0; c < rows; ++c) free_bias_[extent(order[c])] = y_[extent(c)];
  for (int i = 0; i < rows; ++i) rhs_[extent(i)] = problem_.u[extent(i)] - free_bias_[extent(i)];
  level_rank_sum_ = 0;
  std::fill_n(z_.data(), sizes_.nv, 0.0);
  int first = 0;
  for (int level = 0; level < problem_.levels; ++level) {
    const int last = first + solution_.level_rows[extent(level)];
    solve_level(level, first, last);
    first = last;
  }
}

void Wbosc::solve_level(int level, int first, int last) noexcept {
  const Block x = {x_.data(), stride_};
  const RankRule rule = {options_.rank_tolerance, options_.absolute_floor};
  Reflectors keep = {reflectors_.data(), reflector_beta_.data(), sizes_.nv, level_reflectors_};
  const LevelRange range = {solution_.contact_rank,
                            solution_.actuation_rank,
                            level_rank_sum_,
                            col_t_ + first,
                            col_t_ + last,
                            col_h_,
                            sizes_.nv};
  double* dense = work_.data() + 2 * (stride_ + sizes_.nv + sizes_.task_rows);
  const LevelScratch scratch = {y_.data(), dense, work_.data()};
  double smallest = 0.0;
  const int rank =
      solve_cascade_level(x, range, rule, level_order_.data(), column_norm2_.data(), rhs_.data(),
                          problem_.weight.data(), z_.data(), &keep, &smallest, scratch);
  // Against the longest row of all levels: which level a row stands in does not matter.
  solution_.level_condition[extent(level)] = rank > 0 ? longest_row_ / smallest : 1.0;
  level_reflectors_ = keep.count;
  solution_.level_rank[extent(level)] = rank;
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
    for (int i = 0; i < r; ++i) {  // Tᵀ y = c
      double value = c[i];
      for (int q = 0; q < i; ++q) value -= T_[extent(q * r + i)] * tau_p[q];
      tau_p[i] = value / T_[extent(i * r + i)];
    }
    std::fill(tau_p + r, tau_p + na, 0.0);
    rotate_back(actuation_rotation(), na, tau_p);
  }
  for (int j = 0; j < na; ++j) {
    solution_.asked[extent(actuator_order_[extent(col_u_ + j)])] = tau_p[j];
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
    const double asked = solution_.asked[extent(j)];
    solution_.finite &= std::isfinite(asked);
    tau[j] = problem_.torque_limit ? within_limit(asked, problem_.torque_limit[j]) : asked;
    solution_.limited |= tau[j] != asked;
  }
  if (!solution_.finite) std::fill_n(tau, na, 0.0);  // as it is sent: forces stay numbers
  contact_forces(tau, solution_.f.data());
  if (!problem_.tau_measured) {
    std::copy_n(solution_.f.data(), problem_.contact_rows, solution_.f_measured.data());
  }
  for (int i = 0; i < problem_.internal_rows; ++i) {
    double value = 0.0;
    for (int c = 0; c < problem_.contact_rows; ++c) {
      value += problem_.W_int[extent(i * problem_.contact_rows + c)] * solution_.f[extent(c)];
    }
    solution_.internal[extent(i)] = value;
  }
  double* c = z_.data() + sizes_.nv;  // Zᵀ B τ, then in the levels' coordinates
  const int* order = actuator_order_.data() + col_u_;
  for (int i = 0; i < r; ++i) {
    const double* x = row(k + i) + col_u_;
    double value = 0.0;
    for (int j = i; j < na; ++j) value += x[j] * tau[order[j]];
    c[i] = value;
  }
  rotate({reflectors_.data(), reflector_beta_.data(), sizes_.nv, level_reflectors_}, r, c);
  double* gained = work_.data();
  std::fill_n(gained, problem_.task_rows, 0.0);
  for (int q = 0; q < r; ++q) add_scaled(problem_.task_rows, c[q], row(k + q) + col_t_, gained);
  for (int t = 0; t < problem_.task_rows; ++t) {
    const std::size_t original = extent(level_order_[extent(col_t_ + t)]);
    solution_.achieved[original] = free_bias_[original] + gained[t];
  }
}

}  // namespace footfall::tasks
