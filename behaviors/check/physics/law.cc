// Ranks, torques and forces of a control law at rest; see law.h.
#include "behaviors/check/physics/law.h"

#include <algorithm>
#include <cmath>

#include "behaviors/compiled/control_set.h"
#include "behaviors/compiled/static_values.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

int most_rows(const Behavior& behavior) {
  int most = 0;
  for (const ControlSpec& control : behavior.controls) {
    int rows = 0;
    for (int k = control.tasks.first; k < control.tasks.end(); ++k) {
      rows += behavior.tasks[at(k)].axes.count;
    }
    most = std::max(most, rows);
  }
  return most;
}

tasks::WboscSizes solver_sizes(const Behavior& behavior, const model::ControlModel& model) {
  const int rows = most_rows(behavior) + model.joint_count();
  const int contacts = std::max(1, model.contact_count());
  return {model.nv(), model.joint_count(), 3 * contacts, rows, rows, 0};
}

tasks::ControllerSizes controller_sizes(const Behavior& behavior,
                                        const model::ControlModel& model) {
  tasks::ControllerSizes sizes;
  sizes.task_instances = static_cast<int>(behavior.task_instances.size());
  sizes.task_rows = std::max(1, most_rows(behavior));
  sizes.levels = core::kMaxTasks;
  sizes.contacts = std::max(1, model.contact_count());
  return sizes;
}

tasks::TaskCommand command_of(const TaskSpec& spec) {
  tasks::TaskCommand command;
  command.instance = spec.instance;
  command.type = spec.type;
  command.point = spec.point;
  command.frame = spec.frame;
  command.priority = spec.priority;
  return command;
}

}  // namespace

PhysicsLaw::PhysicsLaw(const Behavior& behavior, const model::ControlModel& model)
    : behavior_(behavior),
      model_(model),
      memory_(std::max(1, static_cast<int>(behavior.task_instances.size())), model.joint_count()),
      solver_(solver_sizes(behavior, model)),
      controller_(model, {}, controller_sizes(behavior, model), behavior.period()),
      control_(std::make_unique<tasks::ActiveControl>()) {
  for (int j = 0; j < model.joint_count(); ++j) actuated_.push_back(6 + j);
}

std::vector<TaskRow> PhysicsLaw::rows(const ControlSpec& control) const {
  const StaticValues values(behavior_);
  std::vector<TaskRow> rows;
  for (int k = control.tasks.first; k < control.tasks.end(); ++k) {
    const TaskSpec& task = behavior_.tasks[at(k)];
    const bool of_joint = tasks::info(task.type).of_joints();
    for (int a = task.axes.first; a < task.axes.end(); ++a) {
      const AxisSpec& axis = behavior_.axes[at(a)];
      const bool unweighted = dependence_of(behavior_, axis.weight).fixed() &&
                              values.of(axis.weight).value_or(1.0) <= 0.0;
      if (!unweighted) rows.push_back({&task, &axis, of_joint});
    }
  }
  return rows;
}

void PhysicsLaw::assemble(const std::vector<int>& contacts, const std::vector<TaskRow>& rows) {
  tasks::WboscProblem& problem = solver_.problem();
  const int n = model_.nv();
  problem.factor = model_.factor();
  problem.bias = model_.bias().data();
  problem.actuated = actuated_.data();
  problem.contact_rows = 3 * static_cast<int>(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const model::Kinematics3& point = model_.point(contacts[i]);
    std::copy_n(point.jacobian.data(), 3 * n, problem.Js.data() + 3 * static_cast<int>(i) * n);
    std::copy_n(point.bias.data(), 3, problem.Js_bias.data() + 3 * i);
  }
  const tasks::LawContext context = {
      &model_, &memory_, 0, behavior_.period(), contacts.data(), static_cast<int>(contacts.size())};
  int count = 0;
  for (const TaskRow& row : rows) {
    tasks::TaskCommand command = command_of(*row.task);
    command.axis_count = 1;
    tasks::AxisCommand axis;
    axis.axis = row.axis->axis;
    tasks::AxisEvaluation unused;
    tasks::task_rows(command, &axis, context, problem.J.data() + count * n,
                     problem.J_bias.data() + count, &unused);
    problem.u[at(count)] = 0.0;
    problem.weight[at(count)] = 1.0;
    problem.level_end[at(count)] = count + 1;
    ++count;
  }
  problem.task_rows = problem.levels = count;
}

RowRanks PhysicsLaw::ranks(const std::vector<int>& contacts, const std::vector<TaskRow>& rows) {
  assemble(contacts, rows);
  solver_.solve();
  RowRanks result;
  result.actuated = solver_.solution().actuation_rank;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    result.added.push_back(solver_.solution().level_rank[i]);
    result.covered += result.added.back();
  }
  return result;
}

std::vector<double> PhysicsLaw::freedom(const std::vector<int>& contacts,
                                        const std::vector<TaskRow>& rows) {
  assemble(contacts, rows);
  tasks::WboscProblem& problem = solver_.problem();
  const int joints = model_.joint_count();
  const int first = problem.task_rows;
  for (int j = 0; j < joints; ++j) {
    double* row = problem.J.data() + (first + j) * model_.nv();
    std::fill_n(row, model_.nv(), 0.0);
    row[6 + j] = 1.0;
    problem.J_bias[at(first + j)] = 0.0;
    problem.u[at(first + j)] = 0.0;
    problem.weight[at(first + j)] = 1.0;
  }
  problem.task_rows += joints;
  problem.level_end[at(problem.levels++)] = problem.task_rows;
  solver_.solve();
  const std::vector<double> before = solver_.solution().achieved;
  std::vector<double> share;
  for (int j = 0; j < joints; ++j) {
    problem.u[at(first + j)] = 1.0;
    solver_.solve();
    problem.u[at(first + j)] = 0.0;
    share.push_back(solver_.solution().achieved[at(first + j)] - before[at(first + j)]);
  }
  return share;
}

RestSolution PhysicsLaw::rest(const ControlSpec& control, const std::vector<double>& internal) {
  tasks::ControlSet& set = control_->primary;
  fill_control_set(behavior_, control, set);
  for (int k = 0; k < control.internals.count; ++k)
    set.internals[at(k)].reference = internal[at(k)];
  RestSolution result;
  result.tau.resize(at(model_.joint_count()));
  controller_.compute(*control_, 0, nullptr, result.tau.data());
  const tasks::ControllerResult& out = controller_.result();
  for (const int contact : control.contacts) result.forces.push_back(out.force[at(contact)]);
  result.internal.assign(out.internal_reference.begin(),
                         out.internal_reference.begin() + control.internals.count);
  result.internal_rank = controller_.primary().solution().named_internal_rank;
  return result;
}

// Torque of 1 N beside that of 0 N, then the tension measured of one of its parts after the other.
// Both are affine.
std::vector<double> PhysicsLaw::tension_shares(const ControlSpec& control, int internal) {
  const auto joints = at(model_.joint_count());
  tasks::ControlSet& set = control_->primary;
  fill_control_set(behavior_, control, set);
  for (tasks::InternalCommand& command : set.internals) command.statics = 0.0;
  std::vector<double> without(joints), asked(joints), measured(joints, 0.0);
  controller_.compute(*control_, 0, nullptr, without.data());
  set.internals[at(internal)].reference = 1.0;
  controller_.compute(*control_, 0, nullptr, asked.data());
  std::vector<double> unused(joints);
  const auto tension = [&] {
    controller_.compute(*control_, 0, measured.data(), unused.data());
    return controller_.result().internal_measured[at(internal)];
  };
  const double none = tension();
  std::vector<double> shares;
  double sum = 0.0;
  for (std::size_t j = 0; j < joints; ++j) {
    measured[j] = asked[j] - without[j];
    shares.push_back(tension() - none);
    measured[j] = 0.0;
    sum += shares.back();
  }
  constexpr double kWhole = 1e-6;
  if (!(std::abs(sum - 1.0) < kWhole)) return {};
  return shares;
}

}  // namespace footfall::behaviors
