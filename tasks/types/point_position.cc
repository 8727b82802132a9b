// point_position; see point_position.h.
#include "tasks/types/point_position.h"

#include "core/index.h"
#include "tasks/rows/rows.h"

namespace footfall::tasks::point_position {

void rows(const RowsRequest& request, const Rows& rows) noexcept {
  position_rows(request, request.model.point(request.point), rows);
}

double measured(const model::ControlModel& model, int point, int axis) noexcept {
  return model.point_position(point)[at(axis)];
}

double velocity(const model::ControlModel& model, int point, int axis) noexcept {
  return model.point(point).velocity[at(axis)];
}

}  // namespace footfall::tasks::point_position
