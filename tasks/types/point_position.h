// point_position: the position of a contact or named point; axes x y z, m.
#pragma once

#include "tasks/rows/task_type.h"

namespace footfall::tasks {

namespace point_position {
void rows(const RowsRequest& request, const Rows& rows) noexcept;
double measured(const model::ControlModel& model, int point, int axis) noexcept;
double velocity(const model::ControlModel& model, int point, int axis) noexcept;
}  // namespace point_position

inline constexpr TaskTypeInfo kPointPosition = {
    .name = "point_position",
    .doc = "a named point or contact",
    .subject = Subject::point,
    .axes = kPositionAxes,
    .frames = kPositionFrames,
    .rows = point_position::rows,
    .measured = point_position::measured,
    .velocity = point_position::velocity,
};

}  // namespace footfall::tasks
