// Kinematics of one contact; see foot_kinematics.h.
#include "engine/estimators/parts/foot_kinematics.h"

#include "core/index.h"

namespace footfall::engine {

FootKinematics foot_kinematics(const model::ControlModel& model, int contact,
                               const model::State& state) noexcept {
  const model::Kinematics3& point = model.point(contact);
  const model::State& last = model.state();
  const std::size_t nv = at(model.nv());
  Vector3d moved = vector_of(point.position) - vector_of(last.p_WB);
  Vector3d velocity = Vector3d::Zero();
  for (std::size_t j = 0; j + 6 < nv; ++j) {
    const double* J = point.jacobian.data() + 6 + j;
    const Vector3d column(J[0], J[nv], J[2 * nv]);
    moved += column * (state.q[j] - last.q[j]);
    velocity += column * state.qd[j];
  }
  const Matrix3d R_BW = matrix_of(model.R_WB()).transpose();
  FootKinematics foot;
  foot.contact = R_BW * moved;
  foot.velocity = R_BW * velocity;
  foot.spin = R_BW * vector_of(model.point_angular_velocity(contact));
  return foot;
}

}  // namespace footfall::engine
