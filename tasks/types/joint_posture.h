// joint_posture: joint positions; the axes are the robot's joints, rad.
#pragma once

#include "tasks/rows/task_type.h"

namespace footfall::tasks {

namespace joint_posture {
void rows(const RowsRequest& request, const Rows& rows) noexcept;
double measured(const model::ControlModel& model, int point, int axis) noexcept;
}  // namespace joint_posture

inline constexpr TaskTypeInfo kJointPosture = {
    .name = "joint_posture",
    .doc = "joint angles",
    .subject = Subject::joints,
    .rows = joint_posture::rows,
    .measured = joint_posture::measured,
};

}  // namespace footfall::tasks
