// Assembly, blending and reports; see whole_body_controller.h.
#include "tasks/whole_body_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/index.h"

namespace footfall::tasks {
namespace {

WboscSizes solver_sizes(const model::ControlModel& model, const ControllerSizes& sizes) {
  const int pairs = sizes.contacts * (sizes.contacts - 1) / 2;
  return {model.nv(),      model.joint_count(), 3 * sizes.contacts,
          sizes.task_rows, sizes.levels,        pairs};
}

// Index of a robot contact within the set, -1 if it does not hold.
int place_in(const ControlSet& set, int contact) noexcept {
  for (int i = 0; i < set.contact_count; ++i) {
    if (set.contacts[at(i)] == contact) return i;
  }
  return -1;
}

std::size_t pair_of(int a, int b) noexcept {
  return at(std::min(a, b) * core::kMaxContacts + std::max(a, b));
}

bool named(const ControlSet& set, int a, int b) noexcept {
  for (int i = 0; i < set.internal_count; ++i) {
    const InternalCommand& c = set.internals[at(i)];
    if ((c.contact_a == a && c.contact_b == b) || (c.contact_a == b && c.contact_b == a))
      return true;
  }
  return false;
}

}  // namespace

WholeBodyController::WholeBodyController(const model::ControlModel& model,
                                         const std::vector<double>& torque_limits,
                                         const ControllerSizes& sizes, double period)
    : model_(model),
      torque_limits_(torque_limits),
      period_(period),
      sizes_(sizes),
      memory_(std::max(1, sizes.task_instances), model.joint_count()),
      primary_(solver_sizes(model, sizes)),
      other_(solver_sizes(model, sizes)) {
  for (int j = 0; j < model.joint_count(); ++j) actuated_.push_back(6 + j);
}

void WholeBodyController::compute(const ActiveControl& control, std::int64_t tick,
                                  const double* tau_measured, double* tau) noexcept {
  const bool frozen = control.has_other && control.form == TransitionForm::frozen;
  const bool both = control.has_other && (!frozen || control.transition_entered);
  std::fill(primary_.problem().external.begin(), primary_.problem().external.end(), 0.0);
  if (both) solve_law(other_, control.other, tick, tau_measured, other_axes_.data());
  if (frozen) {
    if (control.transition_entered) sample_frozen_force(control);
    add_frozen_force(control);
  }
  solve_law(primary_, control.primary, tick, tau_measured, result_.axes.data());

  if (both) keep_filtered(other_, control.other, tick);
  keep_filtered(primary_, control.primary, tick);
  const double w = both && !frozen ? control.other_weight : 0.0;
  const WboscSolution& a = primary_.solution();
  const WboscSolution& b = other_.solution();
  result_.limited = a.limited || (both && b.limited);
  for (int j = 0; j < model_.joint_count(); ++j) {
    tau[j] = a.asked[at(j)];
    if (w > 0.0) tau[j] = (1.0 - w) * a.asked[at(j)] + w * b.asked[at(j)];
  }
  report(control);
}

void WholeBodyController::solve_law(Wbosc& solver, const ControlSet& set, std::int64_t tick,
                                    const double* tau_measured, AxisEvaluation* axes) noexcept {
  WboscProblem& problem = solver.problem();
  problem.factor = model_.factor();
  problem.bias = model_.bias().data();
  problem.actuated = actuated_.data();
  problem.torque_limit = torque_limits_.empty() ? nullptr : torque_limits_.data();
  problem.tau_measured = tau_measured;
  assemble_contacts(problem, set);
  assemble_tasks(problem, set, tick, axes);
  assemble_internal(problem, set, tick);
  solver.solve();
}

void WholeBodyController::assemble_contacts(WboscProblem& problem,
                                            const ControlSet& set) const noexcept {
  const int n = model_.nv();
  problem.contact_rows = 3 * set.contact_count;
  for (int i = 0; i < set.contact_count; ++i) {
    const model::Kinematics3& k = model_.point(set.contacts[at(i)]);
    std::copy_n(k.jacobian.data(), 3 * n, problem.Js.data() + 3 * i * n);
    std::copy_n(k.bias.data(), 3, problem.Js_bias.data() + 3 * i);
  }
}

void WholeBodyController::assemble_tasks(WboscProblem& problem, const ControlSet& set,
                                         std::int64_t tick, AxisEvaluation* axes) noexcept {
  const int n = model_.nv();
  const LawContext context = {&model_,          &memory_, tick, period_, set.contacts.data(),
                              set.contact_count};
  int row = 0;
  int levels = 0;
  for (int t = 0; t < set.task_count; ++t) {
    const TaskCommand& task = set.tasks[at(t)];
    if (row + task.axis_count > sizes_.task_rows) break;
    evaluate_task(task, set.axes.data() + task.first_axis, context, problem.J.data() + row * n,
                  problem.J_bias.data() + row, axes + task.first_axis);
    for (int i = 0; i < task.axis_count; ++i, ++row) {
      problem.u[at(row)] = axes[task.first_axis + i].commanded;
      problem.weight[at(row)] = set.axes[at(task.first_axis + i)].weight;
    }
    const bool opens_level = t == 0 || set.tasks[at(t - 1)].priority != task.priority;
    if (opens_level && levels < sizes_.levels) ++levels;
    problem.level_end[at(levels - 1)] = row;
  }
  problem.task_rows = row;
  problem.levels = levels;
}

// Tension between contacts a and b, mean convention, as a row on f (ground on robot): pushing apart
// means the robot pushes a away from b, so f_a points back: F = -½ x̂ᵀ (f_a - f_b).
// Source: [Kim16] eqs. (7)-(10) with E10 (each foot's force, not the sum).
void WholeBodyController::tension_row(WboscProblem& problem, const ControlSet& set, int row, int a,
                                      int b) const noexcept {
  const int columns = problem.contact_rows;
  double* w = problem.W_int.data() + row * columns;
  std::fill_n(w, columns, 0.0);
  const std::array<double, 3>& pa = model_.point(a).position;
  const std::array<double, 3>& pb = model_.point(b).position;
  const double distance = std::hypot(pa[0] - pb[0], pa[1] - pb[1], pa[2] - pb[2]);
  if (distance < 1e-6) return;  // the same place has no direction; the row stays without rank
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = (pa[k] - pb[k]) / distance;
    w[3 * at(place_in(set, a)) + k] = -0.5 * x;
    w[3 * at(place_in(set, b)) + k] = 0.5 * x;
  }
}

// The low-pass of a pair that was not held in the last tick begins at its reference: feedback comes
// in with the low-pass's own time, whatever the torques before were.
void WholeBodyController::assemble_internal(WboscProblem& problem, const ControlSet& set,
                                            std::int64_t tick) const noexcept {
  int row = 0;
  for (int i = 0; i < set.internal_count; ++i) {
    const InternalCommand& c = set.internals[at(i)];
    if (place_in(set, c.contact_a) < 0 || place_in(set, c.contact_b) < 0) continue;
    tension_row(problem, set, row, c.contact_a, c.contact_b);
    problem.F_int[at(row)] = c.reference;
    problem.K_F[at(row)] = c.feedback;
    const Tension& last = tension_[pair_of(c.contact_a, c.contact_b)];
    constexpr double kTurn = 2.0 * std::numbers::pi;
    problem.measured_share[at(row)] =
        c.bandwidth > 0.0 ? -std::expm1(-kTurn * c.bandwidth * period_) : 1.0;
    problem.measured_before[at(row)] = last.tick == tick - 1 ? last.filtered : c.reference;
    ++row;
  }
  problem.named_internal_rows = row;
  for (int i = 0; i < set.contact_count; ++i) {  // those not named get 0 N
    for (int j = i + 1; j < set.contact_count; ++j) {
      const int a = set.contacts[at(i)];
      const int b = set.contacts[at(j)];
      if (named(set, a, b)) continue;
      tension_row(problem, set, row, a, b);
      problem.F_int[at(row)] = 0.0;
      problem.K_F[at(row)] = 0.0;
      problem.measured_share[at(row)] = 1.0;
      problem.measured_before[at(row)] = 0.0;
      ++row;
    }
  }
  problem.internal_rows = row;
}

void WholeBodyController::keep_filtered(const Wbosc& solver, const ControlSet& set,
                                        std::int64_t tick) noexcept {
  int row = 0;
  for (int i = 0; i < set.internal_count; ++i) {
    const InternalCommand& c = set.internals[at(i)];
    if (place_in(set, c.contact_a) < 0 || place_in(set, c.contact_b) < 0) continue;
    tension_[pair_of(c.contact_a, c.contact_b)] = {solver.solution().internal_filtered[at(row++)],
                                                   tick};
  }
}

void WholeBodyController::sample_frozen_force(const ActiveControl& control) noexcept {
  for (int i = 0; i < control.moving_contact_count; ++i) {
    const int contact = control.moving_contacts[at(i)];
    const int place = place_in(control.other, contact);
    frozen_force_[at(contact)] = {};
    if (place < 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      frozen_force_[at(contact)][k] = other_.solution().f[3 * at(place) + k];
    }
  }
}

void WholeBodyController::add_frozen_force(const ActiveControl& control) noexcept {
  const int n = model_.nv();
  for (int i = 0; i < control.moving_contact_count; ++i) {
    const int contact = control.moving_contacts[at(i)];
    const double* J = model_.point(contact).jacobian.data();
    for (int q = 0; q < n; ++q) {
      for (int k = 0; k < 3; ++k) {
        primary_.problem().external[at(q)] +=
            control.other_weight * J[k * n + q] * frozen_force_[at(contact)][at(k)];
      }
    }
  }
}

void WholeBodyController::report(const ActiveControl& control) noexcept {
  const WboscSolution& a = primary_.solution();
  for (auto& f : result_.force) f = {};
  const bool blended = control.has_other && control.form == TransitionForm::continuous;
  const double w = blended ? control.other_weight : 0.0;
  for (int i = 0; i < control.primary.contact_count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result_.force[at(control.primary.contacts[at(i)])][k] += (1.0 - w) * a.f[3 * at(i) + k];
    }
  }
  for (int i = 0; blended && i < control.other.contact_count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result_.force[at(control.other.contacts[at(i)])][k] += w * other_.solution().f[3 * at(i) + k];
    }
  }
  // The frozen form's moving feet, whose force the primary law takes as given.
  const bool frozen = control.has_other && control.form == TransitionForm::frozen;
  for (int i = 0; frozen && i < control.moving_contact_count; ++i) {
    const int contact = control.moving_contacts[at(i)];
    if (place_in(control.primary, contact) >= 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      result_.force[at(contact)][k] = control.other_weight * frozen_force_[at(contact)][k];
    }
  }
  report_tasks(control);
}

void WholeBodyController::report_tasks(const ActiveControl& control) noexcept {
  const WboscSolution& a = primary_.solution();
  int row = 0;
  int level = 0;
  for (int t = 0; t < control.primary.task_count; ++t) {
    const TaskCommand& task = control.primary.tasks[at(t)];
    if (row >= primary_.problem().level_end[at(level)]) ++level;
    const int rows = a.level_rows[at(level)];
    const int rank = a.level_rank[at(level)];
    result_.tasks[at(t)] = {rows, rank, a.level_condition[at(level)],
                            rows > 0 ? double(rank) / rows : 1.0};
    for (int i = 0; i < task.axis_count; ++i, ++row) {
      result_.achieved[at(task.first_axis + i)] = a.achieved[at(row)];
    }
  }
  int pair = 0;
  for (int i = 0; i < control.primary.internal_count; ++i) {
    const InternalCommand& c = control.primary.internals[at(i)];
    const bool holds =
        place_in(control.primary, c.contact_a) >= 0 && place_in(control.primary, c.contact_b) >= 0;
    constexpr double kNoForce = std::numeric_limits<double>::quiet_NaN();
    result_.internal[at(i)] = holds ? a.internal[at(pair)] : kNoForce;
    result_.internal_measured[at(i)] = holds ? a.internal_measured[at(pair)] : kNoForce;
    if (holds) ++pair;
  }
}

}  // namespace footfall::tasks
