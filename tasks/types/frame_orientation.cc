// frame_orientation; see frame_orientation.h.
#include "tasks/types/frame_orientation.h"

#include "core/index.h"
#include "tasks/rows/rows.h"

namespace footfall::tasks::frame_orientation {

void rows(const RowsRequest& request, const Rows& rows) noexcept {
  const model::FrameRotation& frame = request.model.frame(request.point);
  orientation_rows(request, {frame.angular, frame.R_WF, frame.rpy}, 0, rows);
}

double measured(const model::ControlModel& model, int point, int axis) noexcept {
  return model.frame(point).rpy[at(axis)];
}

}  // namespace footfall::tasks::frame_orientation
