// centroidal_angular_momentum: angular momentum about the centre of mass; axes x y z, kg m^2/s.
#pragma once

#include "tasks/rows/task_type.h"

namespace footfall::tasks {

namespace centroidal_angular_momentum {
inline constexpr std::array<AxisInfo, 3> kMomentumAxes = {
    {{"x", core::kAngularMomentum}, {"y", core::kAngularMomentum}, {"z", core::kAngularMomentum}}};

void rows(const RowsRequest& request, const Rows& rows) noexcept;
double measured(const model::ControlModel& model, int point, int axis) noexcept;
}  // namespace centroidal_angular_momentum

inline constexpr TaskTypeInfo kCentroidalAngularMomentum = {
    .name = "centroidal_angular_momentum",
    .doc = "angular momentum h about the centre of mass: h' = h'_ref + kd e + kp ∫e, no ki",
    .subject = Subject::momentum,
    .axes = centroidal_angular_momentum::kMomentumAxes,
    .frames = kVectorFrames,
    .is_rate = true,
    .gains = "kp kd",
    .gains_note = "an angular momentum has kd (on its error) and kp (on that error's integral)",
    .rows = centroidal_angular_momentum::rows,
    .measured = centroidal_angular_momentum::measured,
};

}  // namespace footfall::tasks
