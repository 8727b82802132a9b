// From the machine's active control to joint torques: assembles the algebra for each control law in
// force, blends the two laws of a contact transition, and reports what every task got.
//
// Contact transitions ([Kim16] III-D, eqs (1)-(2)) have two forms:
//  - continuous: both controllers at every tick on the same state and references,
//      τ = (1 - w) τ_primary + w τ_other. Exact at both ends: w = 1 is the other controller, w = 0
//      this one. It equals the corrected eq. (2) (docs/notation.md E8) whenever both controllers
//      ask for the same task accelerations, and stays exact when they do not.
//  - frozen: the paper's. The moving foot's force f is taken from `other` once, at entry, and
//      enters the primary law as a known force w f: τ = τ_primary(h - w J_swᵀ f).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/control_model.h"
#include "tasks/active_set.h"
#include "tasks/internal_forces.h"
#include "tasks/solver/wbosc.h"
#include "tasks/task_law.h"

namespace footfall::tasks {

struct ControllerSizes {
  int task_instances = 1;
  int task_rows = 32;  // most rows of one control law
  int levels = 8;
  int contacts = 4;
};

struct TaskReport {
  int rows = 0;            // of the task's level: those of a weight above 0
  int rank = 0;            // of the task's level
  double condition = 1.0;  // of the task's level
  double authority = 1.0;  // rank of the level over its rows
};

// Valid until the next compute().
struct ControllerResult {
  std::array<std::array<double, 3>, core::kMaxContacts>
      force{};  // N, ground on robot, per robot contact
  // Likewise under the measured joint torques: each law's, with its weight.
  std::array<std::array<double, 3>, core::kMaxContacts> force_measured{};
  std::array<AxisEvaluation, core::kMaxAxes> axes{};  // as primary.axes
  std::array<double, core::kMaxAxes> achieved{};      // as primary.axes; primary law alone
  std::array<TaskReport, core::kMaxTasks> tasks{};    // as primary.tasks
  std::array<double, core::kMaxInternal>
      internal{};  // N, mean convention, as primary.internals, predicted; NaN: no such contacts
  std::array<double, core::kMaxInternal> internal_reference{};  // N, in force in this tick
  std::array<double, core::kMaxInternal> internal_measured{};   // N, from measured joint torque
  bool limited = false;  // a law asks for more than a joint's limit
};

class WholeBodyController {
 public:
  WholeBodyController(const model::ControlModel& model, const std::vector<double>& torque_limits,
                      const ControllerSizes& sizes, double period);

  // tau_measured: joint torques measured now (internal force feedback); nullptr: none. Writes the
  // torque asked for, N m by joint, before limits, to `tau`; the result's forces and accelerations
  // are those of each law within the limits. Allocates nothing.
  void compute(const ActiveControl& control, std::int64_t tick, const double* tau_measured,
               double* tau) noexcept;

  // Goes on with the integrals of another controller of the same robot; `instances`: its task
  // instances as they are numbered here, -1: not here.
  void take_over(const WholeBodyController& old, const std::vector<int>& instances) noexcept {
    memory_.take_over(old.memory_, instances);
    frozen_force_ = old.frozen_force_;
    internal_.take_over(old.internal_);
  }

  const ControllerResult& result() const noexcept { return result_; }
  // Torques that the two laws alone ask for at the last tick (transition tests and logs).
  const double* tau_primary() const noexcept { return primary_.solution().asked.data(); }
  const double* tau_other() const noexcept { return other_.solution().asked.data(); }
  const Wbosc& primary() const noexcept { return primary_; }

 private:
  void solve_law(Wbosc& solver, const ControlSet& set, bool alone, std::int64_t tick,
                 const double* tau_measured, AxisEvaluation* axes) noexcept;
  void assemble_contacts(WboscProblem& problem, const ControlSet& set) const noexcept;
  void assemble_tasks(WboscProblem& problem, const ControlSet& set, std::int64_t tick,
                      AxisEvaluation* axes) noexcept;
  void sample_frozen_force(const ActiveControl& control) noexcept;
  void add_frozen_force(const ActiveControl& control) noexcept;
  void report(const ActiveControl& control) noexcept;
  void report_tasks(const ActiveControl& control) noexcept;

  const model::ControlModel& model_;
  std::vector<double> torque_limits_;
  std::vector<int> actuated_;
  double period_;
  ControllerSizes sizes_;
  TaskMemory memory_;
  Wbosc primary_;
  Wbosc other_;
  std::array<AxisEvaluation, core::kMaxAxes> other_axes_{};
  std::array<std::array<double, 3>, core::kMaxContacts> frozen_force_{};
  InternalForces internal_;
  ControllerResult result_;
};

}  // namespace footfall::tasks
