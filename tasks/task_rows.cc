// What each type of task measures and its Jacobian; see task_law.h.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/index.h"
#include "tasks/task_law.h"

namespace footfall::tasks {
namespace {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<double, 9>;  // row-major

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

// Where a task's rows go, n columns each.
struct Rows {
  double* J;
  double* bias;
  AxisEvaluation* out;
  int n;
};

// One row: direction a of a 3-row Jacobian.
void add_row(const Rows& rows, int row, const model::Kinematics3& k, const Vector3& a) noexcept {
  const double* j = k.jacobian.data();
  for (int q = 0; q < rows.n; ++q) {
    rows.J[row * rows.n + q] += a[0] * j[q] + a[1] * j[rows.n + q] + a[2] * j[2 * rows.n + q];
  }
  rows.bias[row] += a[0] * k.bias[0] + a[1] * k.bias[1] + a[2] * k.bias[2];
  rows.out[row].velocity += a[0] * k.velocity[0] + a[1] * k.velocity[1] + a[2] * k.velocity[2];
}

// Axis `axis` of a position. With a slope f' the row is that of p - f' x.
void position_row(const model::Kinematics3& k, const AxisCommand& command, Frame frame,
                  const LawContext& context, const Rows& rows, int row) noexcept {
  const model::ControlModel& m = *context.model;
  const int axis = command.axis;
  std::copy_n(k.jacobian.data() + axis * rows.n, rows.n, rows.J + row * rows.n);
  rows.bias[row] = k.bias[at(axis)];
  AxisEvaluation& out = rows.out[row];
  out.measured = k.position[at(axis)];
  out.velocity = k.velocity[at(axis)];
  if (command.slope != 0.0) add_row(rows, row, k, {-command.slope, 0.0, 0.0});
  if (frame == Frame::stance) {
    const double share = 1.0 / context.contact_count;  // without contacts nothing is added
    for (int c = 0; c < context.contact_count; ++c) {
      const model::Kinematics3& stance = m.point(context.contacts[c]);
      Vector3 a{};
      a[at(axis)] = -share;
      add_row(rows, row, stance, a);
      out.measured -= share * stance.position[at(axis)];
    }
  }
  out.error = command.ref - out.measured;
}

// Something that turns: the floating base or a point's frame.
struct Turning {
  const model::Kinematics3& angular;
  const Matrix3& R;
  const Vector3& rpy;
};

Turning turning_of(const TaskCommand& task, const model::ControlModel& m) noexcept {
  if (task.type == TaskType::body_orientation) return {m.base_rotation(), m.R_WB(), m.rpy()};
  const model::FrameRotation& frame = m.frame(task.point);
  return {frame.angular, frame.R_WF, frame.rpy};
}

// x and y of the heading frame (z up), or of the world.
std::array<Vector3, 3> directions(Frame frame, double yaw) noexcept {
  if (frame != Frame::heading) yaw = 0.0;
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {Vector3{c, s, 0.0}, Vector3{-s, c, 0.0}, Vector3{0.0, 0.0, 1.0}};
}

// The axes from `first_axis` on are roll, pitch and yaw; others are left alone.
void orientation_rows(const TaskCommand& task, const AxisCommand* axes, int first_axis, Frame frame,
                      const LawContext& context, const Rows& rows) noexcept {
  const Turning turning = turning_of(task, *context.model);
  Vector3 wanted = turning.rpy;
  for (int i = 0; i < task.axis_count; ++i) {
    if (axes[i].axis >= first_axis) wanted[at(axes[i].axis - first_axis)] = axes[i].ref;
  }
  const Vector3 e = log_between(rotation_of(wanted[0], wanted[1], wanted[2]), turning.R);
  const Frame axes_of = frame == Frame::world ? Frame::world : Frame::heading;
  const std::array<Vector3, 3> basis = directions(axes_of, turning.rpy[2]);
  for (int i = 0; i < task.axis_count; ++i) {
    if (axes[i].axis < first_axis) continue;
    const Vector3& a = basis[at(axes[i].axis - first_axis)];
    add_row(rows, i, turning.angular, a);
    rows.out[i].measured = turning.rpy[at(axes[i].axis - first_axis)];
    rows.out[i].error = a[0] * e[0] + a[1] * e[1] + a[2] * e[2];
  }
}

void momentum_rows(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
                   const Rows& rows) noexcept {
  const model::ControlModel& m = *context.model;
  const std::array<Vector3, 3> basis = directions(task.frame, m.rpy()[2]);
  for (int i = 0; i < task.axis_count; ++i) {
    add_row(rows, i, m.angular_momentum(), basis[at(axes[i].axis)]);
    rows.out[i].measured = rows.out[i].velocity;
    rows.out[i].error = axes[i].ref - rows.out[i].measured;
  }
}

void joint_rows(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
                const Rows& rows) noexcept {
  const model::ControlModel& m = *context.model;
  for (int i = 0; i < task.axis_count; ++i) {
    const int joint = axes[i].axis;
    rows.J[i * rows.n + 6 + joint] = 1.0;
    AxisEvaluation& out = rows.out[i];
    out.measured = m.state().q[at(joint)];
    out.velocity = m.state().qd[at(joint)];
    out.error = task.type == TaskType::joint_damping ? 0.0 : axes[i].ref - out.measured;
  }
}

}  // namespace

void task_rows(const TaskCommand& task, const AxisCommand* axes, const LawContext& context,
               double* J, double* J_bias, AxisEvaluation* out) noexcept {
  const model::ControlModel& m = *context.model;
  const Rows rows = {J, J_bias, out, m.nv()};
  std::fill_n(J, task.axis_count * rows.n, 0.0);
  std::fill_n(J_bias, task.axis_count, 0.0);
  std::fill_n(out, task.axis_count, AxisEvaluation{});
  switch (task.type) {
    case TaskType::com_position:
    case TaskType::point_position:
    case TaskType::frame_pose: {
      const model::Kinematics3& k =
          task.type == TaskType::com_position ? m.com() : m.point(task.point);
      for (int i = 0; i < task.axis_count; ++i) {
        if (axes[i].axis < 3) position_row(k, axes[i], task.frame, context, rows, i);
      }
      if (task.type == TaskType::frame_pose) {
        orientation_rows(task, axes, 3, Frame::heading, context, rows);
      }
      break;
    }
    case TaskType::body_orientation:
    case TaskType::frame_orientation:
      orientation_rows(task, axes, 0, task.frame, context, rows);
      break;
    case TaskType::centroidal_angular_momentum:
      momentum_rows(task, axes, context, rows);
      break;
    case TaskType::joint_posture:
    case TaskType::joint_damping:
      joint_rows(task, axes, context, rows);
      break;
  }
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
    case TaskType::frame_orientation:
      return m.frame(point).rpy[at(axis)];
    case TaskType::frame_pose:
      return axis < 3 ? m.point_position(point)[at(axis)] : m.frame(point).rpy[at(axis - 3)];
    case TaskType::centroidal_angular_momentum:
      return m.centroidal_momentum()[at(3 + axis)];
    case TaskType::joint_posture:
    case TaskType::joint_damping:
      return m.state().q[at(axis)];
  }
  return 0.0;
}

double measured_velocity(const model::ControlModel& m, TaskType type, int point,
                         int axis) noexcept {
  if (axis >= 3) return 0.0;
  if (type == TaskType::com_position) return m.com().velocity[at(axis)];
  const bool point_task = type == TaskType::point_position || type == TaskType::frame_pose;
  return point_task ? m.point(point).velocity[at(axis)] : 0.0;
}

}  // namespace footfall::tasks
