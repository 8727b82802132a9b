// centroidal_angular_momentum; see centroidal_angular_momentum.h.
#include "tasks/types/centroidal_angular_momentum.h"

#include "core/index.h"
#include "tasks/rows/rows.h"

namespace footfall::tasks::centroidal_angular_momentum {

void rows(const RowsRequest& request, const Rows& rows) noexcept {
  vector_rows(request, request.model.angular_momentum(), rows);
}

double measured(const model::ControlModel& model, int /*point*/, int axis) noexcept {
  return model.centroidal_momentum()[at(3 + axis)];
}

}  // namespace footfall::tasks::centroidal_angular_momentum
