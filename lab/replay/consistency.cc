// Normalised errors; see consistency.h.
#include "lab/replay/consistency.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace footfall::lab {
namespace {

Eigen::Quaterniond quaternion_in(const model::State& state) {
  const auto& q = state.q_WB;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

Eigen::Vector3d velocity_in(const model::State& state) {
  return {state.v_WB[0], state.v_WB[1], state.v_WB[2]};
}

// About the vertical, rad, of Z in a rotation S Z with S about a horizontal axis.
double heading_of(const Eigen::Quaterniond& turn) { return 2.0 * std::atan2(turn.z(), turn.w()); }

template <int Size>
double normalised(const Eigen::Matrix<double, Size, 1>& error,
                  const Eigen::Matrix<double, Size, Size>& covariance) {
  const Eigen::LLT<Eigen::Matrix<double, Size, Size>> factor(covariance);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return error.dot(factor.solve(error));
}

}  // namespace

// With R̂ Rᵀ = S Z, Z about the vertical and S about a horizontal axis, the error is that of (R̂, v̂)
// from (Z R, Z v): e = (S's rotation vector, v̂ - Z v). To first order v̂ - Z v is the covariance's
// velocity error less that of the heading, xi_z z x v̂.
NormalisedError normalised_error(const model::State& estimate, const model::State& truth,
                                 const engine::ErrorCovariance& covariance) {
  using Eigen::Vector3d;
  const Eigen::Quaterniond turn = quaternion_in(estimate) * quaternion_in(truth).conjugate();
  const Eigen::Quaterniond heading(Eigen::AngleAxisd(heading_of(turn), Vector3d::UnitZ()));
  Eigen::Quaterniond tilt = turn * heading.conjugate();
  if (tilt.w() < 0.0) tilt.coeffs() *= -1.0;
  const Vector3d v = velocity_in(estimate);
  Eigen::Matrix<double, kNeesDimension, 1> error;
  error << 2.0 * tilt.x(), 2.0 * tilt.y(), v - heading * velocity_in(truth);

  Eigen::Matrix<double, kNeesDimension, 9> map = Eigen::Matrix<double, kNeesDimension, 9>::Zero();
  map(0, 0) = map(1, 1) = 1.0;
  map.block<3, 3>(2, 3).setIdentity();
  map.block<3, 1>(2, 2) = -Vector3d::UnitZ().cross(v);
  const Eigen::Map<const Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> P(covariance.data());
  const Eigen::Matrix<double, kNeesDimension, kNeesDimension> own = map * P * map.transpose();
  return {normalised(error, own), normalised<2>(error.head<2>(), own.topLeftCorner<2, 2>()),
          normalised<3>(error.tail<3>(), own.bottomRightCorner<3, 3>())};
}

StartFrame::StartFrame(const model::State& estimate, const model::State& truth)
    : yaw_(heading_of(quaternion_in(truth) * quaternion_in(estimate).conjugate())),
      truth_(truth.p_WB),
      estimate_(estimate.p_WB) {}

double StartFrame::normalised_place(const model::State& estimate, const model::State& truth,
                                    const engine::ErrorCovariance& covariance) const {
  const Eigen::Vector2d moved(truth.p_WB[0] - truth_[0], truth.p_WB[1] - truth_[1]);
  const Eigen::Vector2d shown(estimate.p_WB[0] - estimate_[0], estimate.p_WB[1] - estimate_[1]);
  const Eigen::Map<const Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> P(covariance.data());
  return normalised<2>(shown - Eigen::Rotation2Dd(-yaw_) * moved, P.block<2, 2>(6, 6));
}

}  // namespace footfall::lab
