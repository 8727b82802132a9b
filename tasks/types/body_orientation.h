// body_orientation: the orientation of the floating base; axes roll pitch yaw, rad.
#pragma once

#include "tasks/rows/task_type.h"

namespace footfall::tasks {

namespace body_orientation {
void rows(const RowsRequest& request, const Rows& rows) noexcept;
double measured(const model::ControlModel& model, int point, int axis) noexcept;
}  // namespace body_orientation

inline constexpr TaskTypeInfo kBodyOrientation = {
    .name = "body_orientation",
    .doc =
        "the floating base's orientation, about the axes of the heading frame; an axis left out "
        "is free",
    .subject = Subject::base_rotation,
    .axes = kOrientationAxes,
    .frames = kOrientationFrames,
    .rows = body_orientation::rows,
    .measured = body_orientation::measured,
};

}  // namespace footfall::tasks
