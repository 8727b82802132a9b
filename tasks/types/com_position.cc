// com_position; see com_position.h.
#include "tasks/types/com_position.h"

#include "core/index.h"
#include "tasks/rows/rows.h"

namespace footfall::tasks::com_position {

void rows(const RowsRequest& request, const Rows& rows) noexcept {
  position_rows(request, request.model.com(), rows);
}

double measured(const model::ControlModel& model, int /*point*/, int axis) noexcept {
  return model.com().position[at(axis)];
}

double velocity(const model::ControlModel& model, int /*point*/, int axis) noexcept {
  return model.com().velocity[at(axis)];
}

}  // namespace footfall::tasks::com_position
