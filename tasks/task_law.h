// The control law of one task: its Jacobian, its error, and the acceleration it asks for.
//
//   u = ẍ_ref + kp e + kd (ẋ_ref - ẋ) + ki ∫e dt,   |∫e| <= integral_limit, |u| <=
//   acceleration_limit
//
// Source: [Kim16] eq. (37). Orientation errors are the logarithm of R_ref R_measuredᵀ on the axes
// of the heading frame (z up, x where the torso points), so that pitch and roll keep their meaning
// whatever the yaw; an axis that is not controlled takes its reference from what is measured.
#pragma once

#include <vector>

#include "model/control_model.h"
#include "tasks/active_set.h"

namespace footfall::tasks {

// One axis of one task after evaluation. Units: m or rad, and their derivatives.
struct AxisEvaluation {
  double measured = 0.0;
  double velocity = 0.0;
  double error = 0.0;      // reference minus measured (log map for orientations)
  double commanded = 0.0;  // u
};

// Integrals of all tasks, kept across states; sized at load.
class TaskMemory {
 public:
  TaskMemory(int instances, int joints);
  double& integral(int instance, int axis) noexcept {
    return integral_[static_cast<std::size_t>(instance * stride_ + axis)];
  }
  // True once per tick and instance: a task that serves two control laws integrates once.
  bool claim(int instance, std::int64_t tick) noexcept;
  void reset(int instance) noexcept;

 private:
  int stride_;
  std::vector<double> integral_;
  std::vector<std::int64_t> last_tick_;
};

// What a law needs besides its command.
struct LawContext {
  const model::ControlModel* model = nullptr;
  TaskMemory* memory = nullptr;
  std::int64_t tick = 0;
  double period = 0.0;      // s
  int stance_contact = -1;  // origin of Frame::stance
};

// Position of one axis as measured now, world frame (orientation: roll, pitch, yaw).
double measured_position(const model::ControlModel& model, TaskType type, int point,
                         int axis) noexcept;

// Writes the task's rows: J (axis_count x nv row-major), bias J̇q̇ and evaluations, one per axis.
void evaluate_task(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
                   double* J, double* J_bias, AxisEvaluation* out) noexcept;

}  // namespace footfall::tasks
