// com_position: the position of the centre of mass; axes x y z, m.
#pragma once

#include "tasks/rows/task_type.h"

namespace footfall::tasks {

namespace com_position {
void rows(const RowsRequest& request, const Rows& rows) noexcept;
double measured(const model::ControlModel& model, int point, int axis) noexcept;
double velocity(const model::ControlModel& model, int point, int axis) noexcept;
}  // namespace com_position

inline constexpr TaskTypeInfo kComPosition = {
    .name = "com_position",
    .doc = "the centre of mass",
    .subject = Subject::com,
    .axes = kPositionAxes,
    .frames = kPositionFrames,
    .rows = com_position::rows,
    .measured = com_position::measured,
    .velocity = com_position::velocity,
};

}  // namespace footfall::tasks
