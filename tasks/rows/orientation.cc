// Rows of orientations: the error is a rotation vector; see rows.h and tasks/task_law.h.
#include <cmath>

#include "core/index.h"
#include "tasks/rows/rows.h"

namespace footfall::tasks {
namespace {

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

}  // namespace

void orientation_rows(const RowsRequest& request, const Turning& turning, int first_axis,
                      const Rows& rows) noexcept {
  Vector3 wanted = turning.rpy;
  for (const AxisCommand& command : request.axes) {
    if (command.axis >= first_axis) wanted[at(command.axis - first_axis)] = command.ref;
  }
  const Vector3 e = log_between(rotation_of(wanted[0], wanted[1], wanted[2]), turning.R);
  const Frame frame = request.frame == Frame::world ? Frame::world : Frame::heading;
  const std::array<Vector3, 3> basis = directions(frame, turning.rpy[2]);
  int row = -1;
  for (const AxisCommand& command : request.axes) {
    ++row;
    if (command.axis < first_axis) continue;
    const Vector3& a = basis[at(command.axis - first_axis)];
    add_row(rows, row, turning.angular, a);
    rows.out[row].measured = turning.rpy[at(command.axis - first_axis)];
    rows.out[row].error = a[0] * e[0] + a[1] * e[1] + a[2] * e[2];
  }
}

}  // namespace footfall::tasks
