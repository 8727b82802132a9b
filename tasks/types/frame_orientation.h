// frame_orientation: the orientation of a named point's frame; axes roll pitch yaw, rad.
#pragma once

#include "tasks/rows/task_type.h"

namespace footfall::tasks {

namespace frame_orientation {
void rows(const RowsRequest& request, const Rows& rows) noexcept;
double measured(const model::ControlModel& model, int point, int axis) noexcept;
}  // namespace frame_orientation

inline constexpr TaskTypeInfo kFrameOrientation = {
    .name = "frame_orientation",
    .doc = "the orientation of a named point's frame; roll, pitch and yaw as in body_orientation",
    .subject = Subject::point,
    .axes = kOrientationAxes,
    .frames = kOrientationFrames,
    .rows = frame_orientation::rows,
    .measured = frame_orientation::measured,
};

}  // namespace footfall::tasks
