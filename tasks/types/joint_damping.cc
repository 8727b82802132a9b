// joint_damping; see joint_damping.h.
#include "tasks/types/joint_damping.h"

#include "core/index.h"
#include "tasks/rows/rows.h"

namespace footfall::tasks::joint_damping {

void rows(const RowsRequest& request, const Rows& rows) noexcept {
  joint_rows(request, rows);
  for (std::size_t i = 0; i < request.axes.size(); ++i) rows.out[i].error = 0.0;
}

double measured(const model::ControlModel& model, int /*point*/, int axis) noexcept {
  return model.state().q[at(axis)];
}

}  // namespace footfall::tasks::joint_damping
