// frame_pose; see frame_pose.h.
#include "tasks/types/frame_pose.h"

#include "core/index.h"
#include "tasks/rows/rows.h"

namespace footfall::tasks::frame_pose {

// The frame's own heading serves its orientation, whatever frame its position is given in.
void rows(const RowsRequest& request, const Rows& rows) noexcept {
  position_rows(request, request.model.point(request.point), rows);
  const RowsRequest turning = {request.model, request.point, Frame::heading, request.axes,
                               request.contacts};
  const model::FrameRotation& frame = request.model.frame(request.point);
  orientation_rows(turning, {frame.angular, frame.R_WF, frame.rpy}, 3, rows);
}

double measured(const model::ControlModel& model, int point, int axis) noexcept {
  return axis < 3 ? model.point_position(point)[at(axis)] : model.frame(point).rpy[at(axis - 3)];
}

double velocity(const model::ControlModel& model, int point, int axis) noexcept {
  return axis < 3 ? model.point(point).velocity[at(axis)] : 0.0;
}

}  // namespace footfall::tasks::frame_pose
