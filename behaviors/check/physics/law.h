// One configuration's control law at rest: task rows and ranks as in the whole-body controller,
// joint torques and contact forces. Load time only.
#pragma once

#include <memory>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "model/control_model.h"
#include "tasks/solver/wbosc.h"
#include "tasks/whole_body_controller.h"

namespace footfall::behaviors {

// One controlled axis of a configuration.
struct TaskRow {
  const TaskSpec* task = nullptr;
  const AxisSpec* axis = nullptr;
  bool of_joint = false;  // of a task on joints, used to control remaining freedom
};

// Ranks of an ordered list of rows, each as its own priority level.
struct RowRanks {
  std::vector<int> added;  // by row: 1 if independent of the rows before it, else 0
  int covered = 0;         // their sum
  int actuated = 0;        // number of directions that torques can move with these contacts
};

// Torques and forces of a control law at rest.
struct RestSolution {
  std::vector<double> tau;                    // N m, by joint, before limits
  std::vector<std::array<double, 3>> forces;  // N, ground on robot, world, by contact of the law
  std::vector<double> internal;               // N at each contact, references in force
  int internal_rank = 0;                      // of the internal forces that the law names
};

class PhysicsLaw {
 public:
  // The model must outlive this object and be updated before each call.
  PhysicsLaw(const Behavior& behavior, const model::ControlModel& model);

  // All rows of a configuration, by priority, then in document order, without those whose weight is
  // always 0: they are no part of their level.
  std::vector<TaskRow> rows(const ControlSpec& control) const;
  // Ranks with each row as its own level, in the given order, by the solver's rank rule.
  RowRanks ranks(const std::vector<int>& contacts, const std::vector<TaskRow>& rows);
  // By joint: fraction of a desired acceleration that the rows leave available, 0 to 1 (diagonal of
  // the orthogonal projector onto the remaining joint accelerations).
  std::vector<double> freedom(const std::vector<int>& contacts, const std::vector<TaskRow>& rows);
  // The law with every task at rest at its reference; `internal`: N at each contact, in the order
  // of control.internals; NaN: by statics, of a force that has its reference from there.
  RestSolution rest(const ControlSpec& control, const std::vector<double>& internal);
  // Of an internal force (index into control.internals), by joint: the part of what is measured of
  // it that the joint's torque makes, when all torques are those that are asked for it. Their sum
  // is 1. Empty: in this posture no torque makes it.
  std::vector<double> tension_shares(const ControlSpec& control, int internal);

 private:
  void assemble(const std::vector<int>& contacts, const std::vector<TaskRow>& rows);

  const Behavior& behavior_;
  const model::ControlModel& model_;
  std::vector<int> actuated_;
  tasks::TaskMemory memory_;
  tasks::Wbosc solver_;
  tasks::WholeBodyController controller_;
  std::unique_ptr<tasks::ActiveControl> control_;
};

}  // namespace footfall::behaviors
