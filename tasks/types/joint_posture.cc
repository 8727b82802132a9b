// joint_posture; see joint_posture.h.
#include "tasks/types/joint_posture.h"

#include "core/index.h"
#include "tasks/rows/rows.h"

namespace footfall::tasks::joint_posture {

void rows(const RowsRequest& request, const Rows& rows) noexcept { joint_rows(request, rows); }

double measured(const model::ControlModel& model, int /*point*/, int axis) noexcept {
  return model.state().q[at(axis)];
}

}  // namespace footfall::tasks::joint_posture
