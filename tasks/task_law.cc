// Task Jacobians and PID laws; see task_law.h.
#include "tasks/task_law.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace footfall::tasks {
namespace {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<double, 9>;  // row-major

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// R = Rz(yaw) Ry(pitch) Rx(roll).
Matrix3 rotation_of(double roll, double pitch, double yaw) noexcept {
  const double cr = std::cos(roll), sr = std::sin(roll);
  const double cp = std::cos(pitch), sp = std::sin(pitch);
  const double cy = std::cos(yaw), sy = std::sin(yaw);
  return {cy * cp,
          cy * sp * sr - sy * cr,
          cy * sp * cr + sy * sr,
          sy * cp,
          sy * sp * sr + cy * cr,
          sy * sp * cr - cy * sr,
          -sp,
          cp * sr,
          cp * cr};
}

// log(A Bᵀ): rotation vector in world axes that turns B into A.
Vector3 log_between(const Matrix3& A, const Matrix3& B) noexcept {
  Matrix3 R{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) R[at(3 * i + j)] += A[at(3 * i + k)] * B[at(3 * j + k)];
    }
  }
  const Vector3 s = {0.5 * (R[7] - R[5]), 0.5 * (R[2] - R[6]), 0.5 * (R[3] - R[1])};
  const double sine = std::hypot(s[0], s[1], s[2]);
  const double cosine = 0.5 * (R[0] + R[4] + R[8] - 1.0);
  // angle/sin(angle); at small angles its series, near pi the axis is lost: the limit stays finite
  // and the safety filter has stopped the robot long before.
  const double angle = std::atan2(sine, cosine);
  const double scale = sine > 1e-9 ? angle / sine : 1.0;
  return {scale * s[0], scale * s[1], scale * s[2]};
}

const model::Kinematics3& translation_of(const TaskCommand& task,
                                         const model::ControlModel& m) noexcept {
  return task.type == TaskType::com_position ? m.com() : m.point(task.point);
}

void point_rows(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
                double* J, double* J_bias, AxisEvaluation* out) noexcept {
  const model::ControlModel& m = *context.model;
  const model::Kinematics3& k = translation_of(task, m);
  const int n = m.nv();
  for (int i = 0; i < task.axis_count; ++i) {
    const int axis = axes[i].axis;
    std::copy_n(k.jacobian.data() + axis * n, n, J + i * n);
    J_bias[i] = k.bias[at(axis)];
    out[i].measured = k.position[at(axis)];
    out[i].velocity = k.velocity[at(axis)];
    if (task.frame == Frame::stance && context.stance_contact >= 0) {
      out[i].measured -= m.point(context.stance_contact).position[at(axis)];
    }
    out[i].error = axes[i].ref - out[i].measured;
  }
}

void orientation_rows(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
                      double* J, double* J_bias, AxisEvaluation* out) noexcept {
  const model::ControlModel& m = *context.model;
  const model::Kinematics3& k = m.base_rotation();
  const int n = m.nv();
  Vector3 wanted = m.rpy();
  for (int i = 0; i < task.axis_count; ++i) wanted[at(axes[i].axis)] = axes[i].ref;
  const Vector3 e = log_between(rotation_of(wanted[0], wanted[1], wanted[2]), m.R_WB());
  const double c = std::cos(m.rpy()[2]);
  const double s = std::sin(m.rpy()[2]);
  const std::array<Vector3, 3> heading = {Vector3{c, s, 0.0}, Vector3{-s, c, 0.0},
                                          Vector3{0.0, 0.0, 1.0}};
  for (int i = 0; i < task.axis_count; ++i) {
    const Vector3& a = heading[at(axes[i].axis)];
    for (int q = 0; q < n; ++q) {
      J[i * n + q] = a[0] * k.jacobian[at(q)] + a[1] * k.jacobian[at(n + q)] +
                     a[2] * k.jacobian[at(2 * n + q)];
    }
    J_bias[i] = a[0] * k.bias[0] + a[1] * k.bias[1] + a[2] * k.bias[2];
    out[i].measured = m.rpy()[at(axes[i].axis)];
    out[i].velocity = a[0] * k.velocity[0] + a[1] * k.velocity[1] + a[2] * k.velocity[2];
    out[i].error = a[0] * e[0] + a[1] * e[1] + a[2] * e[2];
  }
}

void joint_rows(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
                double* J, double* J_bias, AxisEvaluation* out) noexcept {
  const model::ControlModel& m = *context.model;
  const int n = m.nv();
  std::fill_n(J, task.axis_count * n, 0.0);
  for (int i = 0; i < task.axis_count; ++i) {
    const int joint = axes[i].axis;
    J[i * n + 6 + joint] = 1.0;
    J_bias[i] = 0.0;
    out[i].measured = m.state().q[at(joint)];
    out[i].velocity = m.state().qd[at(joint)];
    out[i].error = task.type == TaskType::joint_damping ? 0.0 : axes[i].ref - out[i].measured;
  }
}

}  // namespace

TaskMemory::TaskMemory(int instances, int joints)
    : stride_(std::max(3, joints)),
      integral_(at(instances * stride_), 0.0),
      last_tick_(at(instances), -1) {}

bool TaskMemory::claim(int instance, std::int64_t tick) noexcept {
  std::int64_t& last = last_tick_[at(instance)];
  if (last == tick) return false;
  last = tick;
  return true;
}

void TaskMemory::reset(int instance) noexcept {
  std::fill_n(integral_.data() + instance * stride_, stride_, 0.0);
}

double measured_position(const model::ControlModel& m, TaskType type, int point,
                         int axis) noexcept {
  switch (type) {
    case TaskType::com_position:
      return m.com().position[at(axis)];
    case TaskType::body_orientation:
      return m.rpy()[at(axis)];
    case TaskType::point_position:
      return m.point_position(point)[at(axis)];
    case TaskType::joint_posture:
    case TaskType::joint_damping:
      return m.state().q[at(axis)];
  }
  return 0.0;
}

void evaluate_task(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
                   double* J, double* J_bias, AxisEvaluation* out) noexcept {
  switch (task.type) {
    case TaskType::com_position:
    case TaskType::point_position:
      point_rows(task, axes, context, J, J_bias, out);
      break;
    case TaskType::body_orientation:
      orientation_rows(task, axes, context, J, J_bias, out);
      break;
    case TaskType::joint_posture:
    case TaskType::joint_damping:
      joint_rows(task, axes, context, J, J_bias, out);
      break;
  }
  const bool integrate = context.memory->claim(task.instance, context.tick);
  if (integrate && task.fresh) context.memory->reset(task.instance);
  for (int i = 0; i < task.axis_count; ++i) {
    const AxisCommand& a = axes[i];
    double& integral = context.memory->integral(task.instance, a.axis);
    if (integrate) {
      integral += out[i].error * context.period;
      if (task.integral_limit > 0.0) {
        integral = std::clamp(integral, -task.integral_limit, task.integral_limit);
      }
    }
    double u =
        a.ref_acc + a.kp * out[i].error + a.kd * (a.ref_vel - out[i].velocity) + a.ki * integral;
    if (task.acceleration_limit > 0.0) {
      u = std::clamp(u, -task.acceleration_limit, task.acceleration_limit);
    }
    out[i].commanded = u;
  }
}

}  // namespace footfall::tasks
