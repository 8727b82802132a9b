// body_orientation; see body_orientation.h.
#include "tasks/types/body_orientation.h"

#include "core/index.h"
#include "tasks/rows/rows.h"

namespace footfall::tasks::body_orientation {

void rows(const RowsRequest& request, const Rows& rows) noexcept {
  const model::ControlModel& m = request.model;
  orientation_rows(request, {m.base_rotation(), m.R_WB(), m.rpy()}, 0, rows);
}

double measured(const model::ControlModel& model, int /*point*/, int axis) noexcept {
  return model.rpy()[at(axis)];
}

}  // namespace footfall::tasks::body_orientation
