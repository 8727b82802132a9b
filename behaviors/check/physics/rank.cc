// Ranks of a configuration's tasks in one posture; see parts.h.
//
// A row adds rank if, within the accelerations that torques can produce under the contacts, it is
// independent of the rows before it. Conflicting rows are found by omitting rows and computing the
// ranks again, always by the solver's own rank rule.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "behaviors/check/physics/parts.h"

namespace footfall::behaviors {
namespace {

using core::Severity;
using tasks::Subject;

const std::string& task_name(const Behavior& behavior, const TaskRow& row) {
  return behavior.task_instances[static_cast<std::size_t>(row.task->instance)].name;
}

bool holds(const std::vector<int>& contacts, int point) {
  return std::find(contacts.begin(), contacts.end(), point) != contacts.end();
}

// Point contacts give no moment about a line through all of them; about a vertical line gravity
// gives none either, so that only the limbs can produce a temporary rotation about it. Limit: the
// solver's rank rule, relative to 1 m.
bool has_vertical_moment(const PhysicsContext& context, const std::vector<int>& contacts) {
  const double limit = tasks::WboscOptions{}.rank_tolerance;
  const auto& first = context.model.point_position(contacts.front());
  return std::any_of(contacts.begin(), contacts.end(), [&](int c) {
    const auto& p = context.model.point_position(c);
    return std::hypot(p[0] - first[0], p[1] - first[1]) > limit;
  });
}

class RankCheck {
 public:
  RankCheck(PhysicsContext& context, const ControlSpec& control)
      : context_(context),
        control_(control),
        place_(control.contacts.empty()
                   ? "in the air"
                   : "on " + contacts_text(context.behavior, control.contacts)) {}

  void run(core::Mark state) {
    std::vector<TaskRow> rows = context_.law.rows(control_);
    if (rows.empty() && control_.contacts.empty()) return;
    drop_unsupported_turns(rows);
    const RowRanks ranks = context_.law.ranks(control_.contacts, rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (ranks.added[i] == 0) explain(rows, i);
    }
    if (ranks.covered < ranks.actuated) {
      report_freedom(rows, ranks, rows.empty() ? state : rows.front().task->mark);
    }
  }

 private:
  int rank_of_last(const std::vector<TaskRow>& rows) {
    return context_.law.ranks(control_.contacts, rows).added.back();
  }

  void drop_unsupported_turns(std::vector<TaskRow>& rows) {
    if (control_.contacts.empty() || has_vertical_moment(context_, control_.contacts)) return;
    std::erase_if(rows, [&](const TaskRow& row) {
      constexpr int kYawAxis = 2;
      if (tasks::info(row.task->type).subject != Subject::base_rotation ||
          row.axis->axis != kYawAxis)
        return false;
      report_impossible(row, "a point foot gives no moment about the vertical");
      return true;
    });
  }

  void explain(const std::vector<TaskRow>& rows, std::size_t i) {
    const TaskRow& row = rows[i];
    if (rank_of_last({row}) == 0) {
      explain_alone(row);
      return;
    }
    std::vector<TaskRow> level;  // rows of the same priority up to and including this one
    for (std::size_t k = 0; k <= i; ++k) {
      if (rows[k].task->priority == row.task->priority) level.push_back(rows[k]);
    }
    if (rank_of_last(level) == 1) return;  // loss to a higher priority is intended
    report_conflict(row, rivals(level));
  }

  void explain_alone(const TaskRow& row) {
    if (row.of_joint) return;  // a joint that contacts hold still is damped already
    const tasks::TaskTypeInfo& type = tasks::info(row.task->type);
    if (type.of_point() && type.is_length(row.axis->axis) &&
        holds(control_.contacts, row.task->point)) {
      const Behavior& b = context_.behavior;
      context_.findings.add(
          Severity::error, row.axis->mark, "no-authority", axis_name(b, row),
          fmt::format("task '{}' cannot move '{}': {} is held by its own contact {}",
                      task_name(b, row), axis_name(b, row),
                      b.robot.contacts[static_cast<std::size_t>(row.task->point)].name, place_));
      return;
    }
    report_impossible(row, {});
  }

  void report_impossible(const TaskRow& row, const std::string& why) {
    const std::string axis = axis_name(context_.behavior, row);
    context_.findings.add(
        Severity::error, row.axis->mark, "no-authority", axis,
        fmt::format("task '{}' cannot meet '{}' {}: no contact can produce it{}{}; leave the "
                    "axis out here",
                    task_name(context_.behavior, row), axis, place_, why.empty() ? "" : ", ", why));
  }

  // Earlier rows of the level whose omission makes the last one feasible.
  std::vector<TaskRow> rivals(const std::vector<TaskRow>& level) {
    std::vector<TaskRow> found;
    for (std::size_t k = 0; k + 1 < level.size(); ++k) {
      std::vector<TaskRow> without = level;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(k));
      if (rank_of_last(without) == 1) found.push_back(level[k]);
    }
    return found;
  }

  // Conflicts are intended between rows of different weights; and joints of a closed chain that are
  // all held or damped do not contradict each other.
  static bool is_meant(const TaskRow& row, const std::vector<TaskRow>& others) {
    const auto weighted = [](const TaskRow& r) { return r.axis->weight >= 0; };
    const auto of_joint = [](const TaskRow& r) { return r.of_joint; };
    return weighted(row) || std::any_of(others.begin(), others.end(), weighted) ||
           (row.of_joint && std::all_of(others.begin(), others.end(), of_joint));
  }

  void report_conflict(const TaskRow& row, const std::vector<TaskRow>& others) {
    if (is_meant(row, others)) return;
    const Behavior& b = context_.behavior;
    std::vector<std::string> names;
    for (const TaskRow& other : others) {
      const std::string name = fmt::format("'{}'", task_name(b, other));
      if (other.task->instance == row.task->instance) continue;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    const std::string rival =
        names.empty() ? "the task's other axes" : fmt::format("{}", fmt::join(names, ", "));
    context_.findings.add(
        Severity::warning, row.axis->mark, "task-conflict", axis_name(b, row),
        fmt::format("task '{}' fights with {} of the same priority {}: {} '{}' cannot be met "
                    "together with them; give it a priority of its own, or a weight",
                    task_name(b, row), rival, row.task->priority, place_, axis_name(b, row)));
  }

  void report_freedom(const std::vector<TaskRow>& rows, const RowRanks& ranks, core::Mark mark) {
    const std::vector<double> share = context_.law.freedom(control_.contacts, rows);
    std::vector<std::size_t> order(share.size());
    for (std::size_t j = 0; j < order.size(); ++j) order[j] = j;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return share[a] > share[b]; });
    std::vector<std::string> movers;
    for (const std::size_t j : order) {
      if (movers.size() == 3 || share[j] < 0.5 * share[order.front()]) break;
      movers.push_back(context_.behavior.robot.joints[j].name);
    }
    const int left = ranks.actuated - ranks.covered;
    context_.findings.add(
        Severity::warning, mark, "free-direction", fmt::format("{}", left),
        fmt::format("{} of {} actuated directions {} no task {}: {} may drift; add a "
                    "joint_damping of a last priority",
                    left, ranks.actuated, left == 1 ? "has" : "have", place_,
                    fmt::join(movers, ", ")));
  }

  PhysicsContext& context_;
  const ControlSpec& control_;
  std::string place_;
};

}  // namespace

std::string contacts_text(const Behavior& behavior, const std::vector<int>& contacts) {
  std::string text;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (i > 0) text += i + 1 < contacts.size() ? ", " : " and ";
    text += behavior.robot.contacts[static_cast<std::size_t>(contacts[i])].name;
  }
  if (contacts.size() == 1) text += " alone";
  return text.empty() ? "no contact" : text;
}

std::string axis_name(const Behavior& behavior, const TaskRow& row) {
  return tasks::axis_names(row.task->type,
                           behavior.robot)[static_cast<std::size_t>(row.axis->axis)];
}

void check_ranks(PhysicsContext& context, const ControlSpec& control, core::Mark state) {
  RankCheck(context, control).run(state);
}

}  // namespace footfall::behaviors
