// Rows of positions, free vectors and joints; see rows.h.
#include "tasks/rows/rows.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace footfall::tasks {
namespace {

// Axis `axis` of a position. With a slope f' the row is that of p - f' x.
void position_row(const RowsRequest& request, const model::Kinematics3& k,
                  const AxisCommand& command, const Rows& rows, int row) noexcept {
  const int axis = command.axis;
  std::copy_n(k.jacobian.data() + axis * rows.n, rows.n, rows.J + row * rows.n);
  rows.bias[row] = k.bias[at(axis)];
  AxisEvaluation& out = rows.out[row];
  out.measured = k.position[at(axis)];
  out.velocity = k.velocity[at(axis)];
  if (command.slope != 0.0) add_row(rows, row, k, {-command.slope, 0.0, 0.0});
  if (request.frame == Frame::stance) {
    // Without contacts nothing is added.
    const double share = 1.0 / static_cast<double>(request.contacts.size());
    for (const int contact : request.contacts) {
      const model::Kinematics3& stance = request.model.point(contact);
      Vector3 a{};
      a[at(axis)] = -share;
      add_row(rows, row, stance, a);
      out.measured -= share * stance.position[at(axis)];
    }
  }
  out.error = command.ref - out.measured;
}

}  // namespace

void add_row(const Rows& rows, int row, const model::Kinematics3& k, const Vector3& a) noexcept {
  const double* j = k.jacobian.data();
  for (int q = 0; q < rows.n; ++q) {
    rows.J[row * rows.n + q] += a[0] * j[q] + a[1] * j[rows.n + q] + a[2] * j[2 * rows.n + q];
  }
  rows.bias[row] += a[0] * k.bias[0] + a[1] * k.bias[1] + a[2] * k.bias[2];
  rows.out[row].velocity += a[0] * k.velocity[0] + a[1] * k.velocity[1] + a[2] * k.velocity[2];
}

std::array<Vector3, 3> directions(Frame frame, double yaw) noexcept {
  if (frame != Frame::heading) yaw = 0.0;
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {Vector3{c, s, 0.0}, Vector3{-s, c, 0.0}, Vector3{0.0, 0.0, 1.0}};
}

void position_rows(const RowsRequest& request, const model::Kinematics3& k,
                   const Rows& rows) noexcept {
  int row = 0;
  for (const AxisCommand& command : request.axes) {
    if (command.axis < 3) position_row(request, k, command, rows, row);
    ++row;
  }
}

void vector_rows(const RowsRequest& request, const model::Kinematics3& k,
                 const Rows& rows) noexcept {
  const std::array<Vector3, 3> basis = directions(request.frame, request.model.rpy()[2]);
  int row = 0;
  for (const AxisCommand& command : request.axes) {
    add_row(rows, row, k, basis[at(command.axis)]);
    AxisEvaluation& out = rows.out[row++];
    out.measured = out.velocity;
    out.error = command.ref - out.measured;
  }
}

void joint_rows(const RowsRequest& request, const Rows& rows) noexcept {
  const model::State& state = request.model.state();
  int row = 0;
  for (const AxisCommand& command : request.axes) {
    rows.J[row * rows.n + 6 + command.axis] = 1.0;
    AxisEvaluation& out = rows.out[row++];
    out.measured = state.q[at(command.axis)];
    out.velocity = state.qd[at(command.axis)];
    out.error = command.ref - out.measured;
  }
}

}  // namespace footfall::tasks
