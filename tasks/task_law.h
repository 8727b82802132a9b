// The control law of one task: its Jacobian, its error, and the acceleration it asks for.
//
//   u = ẍ_ref + kp e + kd (ẋ_ref - ẋ) + ki ∫e dt,   |∫e| <= integral_limit, |u| <=
//   acceleration_limit
//
// Source: [Kim16] eq. (37). Orientation errors are the logarithm of R_ref R_measuredᵀ on the axes
// of the heading frame (z up, x where the torso, or the frame itself, points), so that pitch and
// roll keep their meaning whatever the yaw; an axis that is not controlled takes its reference from
// what is measured. Frame::world gives the same vector on the world's axes.
//
// Angular momentum h is known as a rate only, so its law is the one above, one derivative up: kd
// acts on h's error, kp on the integral of that error, and ḣ_ref is the reference's derivative:
//   ḣ = ḣ_ref + kd (h_ref - h) + kp ∫(h_ref - h) dt
//
// Frame::stance measures positions from the mean of the contact points in force: the rows are
// J - mean J_c. While these contacts hold, J_c q̈ + J̇_c q̇ = 0, and the torques are those of
// Frame::world with the reference moved along. (The contact point of a ball that rolls travels on
// by radius times angle; as elsewhere the rows are those of the material points.)
#pragma once

#include <vector>

#include "model/control_model.h"
#include "tasks/active_set.h"

namespace footfall::tasks {

// Integrals of all tasks, kept across states; sized at load.
class TaskMemory {
 public:
  TaskMemory(int instances, int joints);
  double& integral(int instance, int axis) noexcept {
    return integral_[static_cast<std::size_t>(instance * stride_ + axis)];
  }
  // True once per tick, instance and axis: a task that serves two control laws integrates once.
  bool claim(int instance, int axis, std::int64_t tick) noexcept;
  // The integrals of another memory of the same robot, whose instance i is `instances[i]` here (-1:
  // none); the rest are 0.
  void take_over(const TaskMemory& old, const std::vector<int>& instances) noexcept;

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
  double period = 0.0;            // s
  const int* contacts = nullptr;  // that hold: the origin of Frame::stance is their mean
  int contact_count = 0;
};

// One axis as measured now, world frame (orientation: roll, pitch, yaw; angular momentum: about the
// CoM), and its velocity where it is that of a position (else 0).
double measured_position(const model::ControlModel& model, TaskType type, int point,
                         int axis) noexcept;
double measured_velocity(const model::ControlModel& model, TaskType type, int point,
                         int axis) noexcept;

// Writes the task's rows, Jacobian, bias and what is measured, without its gains' law.
void task_rows(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
               double* J, double* J_bias, AxisEvaluation* out) noexcept;

// The same with the law: J (axis_count x nv row-major), bias J̇q̇ and evaluations, one per axis.
void evaluate_task(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
                   double* J, double* J_bias, AxisEvaluation* out) noexcept;

}  // namespace footfall::tasks
