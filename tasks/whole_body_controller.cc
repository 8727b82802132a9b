// Assembly, blending and reports; see whole_body_controller.h.
#include "tasks/whole_body_controller.h"

#include <algorithm>
#include <limits>

#include "core/index.h"

namespace footfall::tasks {
namespace {

WboscSizes solver_sizes(const model::ControlModel& model, const ControllerSizes& sizes) {
  return {model.nv(),      model.joint_count(), 3 * sizes.contacts + model.held_count(),
          sizes.task_rows, sizes.levels,        internal_rows(sizes.contacts)};
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
      other_(solver_sizes(model, sizes)),
      internal_(model, period, internal_rows(sizes.contacts)) {
  for (int j = 0; j < model.joint_count(); ++j) actuated_.push_back(6 + j);
}

void WholeBodyController::compute(const ActiveControl& control, std::int64_t tick,
                                  const double* tau_measured, double* tau) noexcept {
  const bool frozen = control.has_other && control.form == TransitionForm::frozen;
  const bool both = control.has_other && (!frozen || control.transition_entered);
  std::fill(primary_.problem().external.begin(), primary_.problem().external.end(), 0.0);
  const double w = both && !frozen ? control.other_weight : 0.0;
  if (both) solve_law(other_, control.other, w == 1.0, tick, tau_measured, other_axes_.data());
  if (frozen) {
    if (control.transition_entered) sample_frozen_force(control);
    add_frozen_force(control);
  }
  solve_law(primary_, control.primary, w == 0.0, tick, tau_measured, result_.axes.data());

  if (both) internal_.keep(other_, control.other, tick, w == 1.0);
  internal_.keep(primary_, control.primary, tick, w == 0.0);
  const WboscSolution& a = primary_.solution();
  const WboscSolution& b = other_.solution();
  result_.limited = a.limited || (both && b.limited);
  for (int j = 0; j < model_.joint_count(); ++j) {
    tau[j] = a.asked[at(j)];
    if (w > 0.0) tau[j] = (1.0 - w) * a.asked[at(j)] + w * b.asked[at(j)];
  }
  report(control);
}

void WholeBodyController::solve_law(Wbosc& solver, const ControlSet& set, bool alone,
                                    std::int64_t tick, const double* tau_measured,
                                    AxisEvaluation* axes) noexcept {
  WboscProblem& problem = solver.problem();
  problem.factor = model_.factor();
  problem.bias = model_.bias().data();
  problem.actuated = actuated_.data();
  problem.torque_limit = torque_limits_.empty() ? nullptr : torque_limits_.data();
  problem.tau_measured = tau_measured;
  assemble_contacts(problem, set);
  assemble_tasks(problem, set, tick, axes);
  problem.hold_integral = result_.limited;
  internal_.assemble(problem, set, tick, alone);
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
  for (int i = 0; i < model_.held_count(); ++i) {
    const int row = problem.contact_rows++;
    std::copy_n(model_.held_jacobian(i), n, problem.Js.data() + row * n);
    problem.Js_bias[at(row)] = model_.held_bias(i);
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
  for (auto& f : result_.force_measured) f = {};
  const bool blended = control.has_other && control.form == TransitionForm::continuous;
  const double w = blended ? control.other_weight : 0.0;
  for (int i = 0; i < control.primary.contact_count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t contact = at(control.primary.contacts[at(i)]);
      result_.force[contact][k] += (1.0 - w) * a.f[3 * at(i) + k];
      result_.force_measured[contact][k] += (1.0 - w) * a.f_measured[3 * at(i) + k];
    }
  }
  for (int i = 0; blended && i < control.other.contact_count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t contact = at(control.other.contacts[at(i)]);
      result_.force[contact][k] += w * other_.solution().f[3 * at(i) + k];
      result_.force_measured[contact][k] += w * other_.solution().f_measured[3 * at(i) + k];
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
  int force = 0;
  for (int i = 0; i < control.primary.internal_count; ++i) {
    const bool here = holds(control.primary, control.primary.internals[at(i)]);
    constexpr double kNoForce = std::numeric_limits<double>::quiet_NaN();
    result_.internal_reference[at(i)] = here ? primary_.problem().F_int[at(force)] : kNoForce;
    result_.internal[at(i)] = here ? a.internal[at(force)] : kNoForce;
    result_.internal_measured[at(i)] = here ? a.internal_measured[at(force)] : kNoForce;
    if (here) ++force;
  }
}

}  // namespace footfall::tasks
