// Rows that several task types share: positions, orientations, free vectors, joints. See
// tasks/task_law.h for the conventions. Realtime: nothing here allocates.
#pragma once

#include <array>

#include "model/control_model.h"
#include "tasks/rows/task_type.h"

namespace footfall::tasks {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<double, 9>;  // row-major

// Adds to one row (Jacobian, bias, velocity) the direction `a` of a 3-row Jacobian.
void add_row(const Rows& rows, int row, const model::Kinematics3& k, const Vector3& a) noexcept;

// Unit vectors x, y, z of the heading frame (z up, turned by `yaw`), or of the world.
std::array<Vector3, 3> directions(Frame frame, double yaw) noexcept;

// Axes 0 to 2 of the request: x, y, z of a position. Further axes are left alone.
void position_rows(const RowsRequest& request, const model::Kinematics3& k,
                   const Rows& rows) noexcept;

// Something that turns: the floating base or a point's frame.
struct Turning {
  const model::Kinematics3& angular;  // velocity = ω, world axes
  const Matrix3& R;                   // of the body in the world
  const Vector3& rpy;                 // rad, R = Rz(yaw) Ry(pitch) Rx(roll)
};

// The axes from `first_axis` on are roll, pitch and yaw; others are left alone.
void orientation_rows(const RowsRequest& request, const Turning& turning, int first_axis,
                      const Rows& rows) noexcept;

// Axes x, y, z of a rate that is a free vector (k.velocity), on the request's frame.
void vector_rows(const RowsRequest& request, const model::Kinematics3& k,
                 const Rows& rows) noexcept;

// Joint positions; the axis is the joint's index.
void joint_rows(const RowsRequest& request, const Rows& rows) noexcept;

}  // namespace footfall::tasks
