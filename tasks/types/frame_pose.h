// frame_pose: position and orientation of a named point's frame; axes x y z (m) roll pitch yaw
// (rad).
#pragma once

#include "tasks/rows/task_type.h"

namespace footfall::tasks {

namespace frame_pose {
inline constexpr std::array<AxisInfo, 6> kPoseAxes = {{{"x", core::kLength},
                                                       {"y", core::kLength},
                                                       {"z", core::kLength},
                                                       {"roll", core::kNone},
                                                       {"pitch", core::kNone},
                                                       {"yaw", core::kNone}}};

void rows(const RowsRequest& request, const Rows& rows) noexcept;
double measured(const model::ControlModel& model, int point, int axis) noexcept;
double velocity(const model::ControlModel& model, int point, int axis) noexcept;
}  // namespace frame_pose

inline constexpr TaskTypeInfo kFramePose = {
    .name = "frame_pose",
    .doc = "place and orientation of a named point's frame",
    .subject = Subject::point,
    .axes = frame_pose::kPoseAxes,
    .frames = kPositionFrames,
    .rows = frame_pose::rows,
    .measured = frame_pose::measured,
    .velocity = frame_pose::velocity,
};

}  // namespace footfall::tasks
