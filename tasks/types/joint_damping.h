// joint_damping: joint velocities to 0; the axes are the robot's joints.
#pragma once

#include "tasks/rows/task_type.h"

namespace footfall::tasks {

namespace joint_damping {
void rows(const RowsRequest& request, const Rows& rows) noexcept;
double measured(const model::ControlModel& model, int point, int axis) noexcept;
}  // namespace joint_damping

inline constexpr TaskTypeInfo kJointDamping = {
    .name = "joint_damping",
    .doc = "brings joints to rest: kd only, no reference",
    .subject = Subject::joints,
    .has_reference = false,
    .gains = "kd",
    .gains_note = "joint_damping has kd only",
    .rows = joint_damping::rows,
    .measured = joint_damping::measured,
};

}  // namespace footfall::tasks
