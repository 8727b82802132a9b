// Contact and internal forces of the reduced WBOSC, and effective inertia; see wbosc.h.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/index.h"
#include "tasks/solver/wbosc.h"

namespace footfall::tasks {
// f = R⁻¹ (a₁ - B₁ τ + h₁): ground on robot; of least norm where contacts are redundant.
void Wbosc::contact_forces(const double* tau, double* f) noexcept {
  const int k = solution_.contact_rank;
  const int nc = problem_.contact_rows;
  const int na = sizes_.na;
  double* tau_p = work_.data();
  double* y = tau_p + na;
  double* fp = y + k;
  const int* order = actuator_order_.data() + col_u_;
  for (int j = 0; j < na; ++j) tau_p[j] = tau[order[j]];
  for (int i = 0; i < k; ++i) {
    const double* x = row(i) + col_u_;
    double value = a1_[extent(i)] + row(i)[col_h_];
    for (int j = 0; j < na; ++j) value -= x[j] * tau_p[j];
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
      for (int q = 0; q < i; ++q) value -= Tc_[extent(q * k + i)] * fp[q];
      fp[i] = value / Tc_[extent(i * k + i)];
    }
    std::fill(fp + k, fp + nc, 0.0);
    rotate_back(contact_rotation(), nc, fp);
  }
  for (int i = 0; i < nc; ++i) f[contact_order_[extent(i)]] = fp[i];
}

// In the null space of B torques only change contact forces: W_int f(τ + N α) = F_int, named rows
// first, the others in what those left.
void Wbosc::add_internal_forces() noexcept {
  const int na = sizes_.na;
  const int nc = problem_.contact_rows;
  const int r = solution_.actuation_rank;
  const int nulls = na - r;
  const int rows = problem_.internal_rows;
  solution_.internal_rank = solution_.named_internal_rank = 0;
  if (problem_.tau_measured) contact_forces(problem_.tau_measured, solution_.f_measured.data());
  if (rows == 0) return;
  double* f0 = forces_.data();
  double* f1 = f0 + nc;
  double* probe = f1 + nc;
  contact_forces(solution_.asked.data(), f0);
  std::fill_n(internal_norm2_.data(), rows, 0.0);
  for (int q = 0; q < nulls; ++q) {  // column q of G = W_int ∂f/∂α_q, stored transposed
    for (int j = 0; j < na; ++j) {
      const int actuator = actuator_order_[extent(col_u_ + j)];
      probe[actuator] = solution_.asked[extent(actuator)] + N_[extent(q * na + j)];
    }
    contact_forces(probe, f1);
    for (int i = 0; i < rows; ++i) {
      double value = 0.0;
      for (int c = 0; c < nc; ++c) value += problem_.W_int[extent(i * nc + c)] * (f1[c] - f0[c]);
      G_[extent(q * rows + i)] = value;
      internal_norm2_[extent(i)] += value * value;
    }
  }
  for (int i = 0; i < rows; ++i) {
    double now = 0.0;
    double measured = 0.0;
    for (int c = 0; c < nc; ++c) {
      now += problem_.W_int[extent(i * nc + c)] * f0[c];
      measured += problem_.W_int[extent(i * nc + c)] * solution_.f_measured[extent(c)];
    }
    rhs_[extent(i)] = problem_.F_int[extent(i)] - now;
    feed_back(i, problem_.tau_measured ? measured : now);
    internal_order_[extent(i)] = i;
  }
  if (nulls > 0) add_null_torque(nulls, rows);
}

// What is measured of a row, and what feedback adds to its command. A measurement that is not a
// number leaves the error as it was.
void Wbosc::feed_back(int row, double measured) noexcept {
  const std::size_t i = extent(row);
  const double before = problem_.error_before[i];
  const double old = problem_.integral_before[i];
  solution_.internal_measured[i] = measured;
  solution_.internal_error[i] = before;
  solution_.internal_integral[i] = old;
  if (!problem_.tau_measured) return;
  double error = before;
  if (std::isfinite(measured)) {
    const double now = problem_.error_part[i] * (problem_.F_before[i] - measured);
    error += problem_.error_share[i] * (now - before);
  }
  const double gain = problem_.integral_gain[i];
  double integral = gain > 0.0 ? old + gain * error : old * (1.0 - problem_.error_share[i]);
  if (problem_.hold_integral && std::abs(integral) > std::abs(old)) integral = old;
  const double limit = problem_.integral_limit[i];
  if (limit >= 0.0) integral = within_limit(integral, limit);
  solution_.internal_error[i] = error;
  solution_.internal_integral[i] = integral;
  rhs_[i] += problem_.K_F[i] * error + integral;
}

// Solves Gᵀ's two-level cascade for α and adds N α to the torque.
void Wbosc::add_null_torque(int nulls, int rows) noexcept {
  const int na = sizes_.na;
  const Block g = {G_.data(), rows};
  const RankRule rule = {options_.internal_rank_tolerance, options_.absolute_floor};
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
    solution_.internal_rank = done;
    if (level == 1) solution_.named_internal_rank = done;
  }
  rotate_back(keep, nulls, alpha_.data());
  for (int j = 0; j < na; ++j) {
    double value = 0.0;
    for (int q = 0; q < nulls; ++q) value += N_[extent(q * na + j)] * alpha_[extent(q)];
    solution_.asked[extent(actuator_order_[extent(col_u_ + j)])] += value;
  }
}

}  // namespace footfall::tasks
