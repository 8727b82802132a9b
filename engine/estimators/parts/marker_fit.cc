// The closed form; see marker_fit.h.
#include "engine/estimators/parts/marker_fit.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace footfall::engine {
namespace {

// Z Zᵀ and Y Zᵀ of the centred columns.
struct Moments {
  Matrix3d zz = Matrix3d::Zero(), yz = Matrix3d::Zero();
};

Moments centred_moments(std::span<const MarkerPair> markers, AffineFit& fit) noexcept {
  Moments moments;
  fit.markers = static_cast<int>(markers.size());
  if (markers.empty()) return moments;
  for (const MarkerPair& m : markers) {
    fit.mean_place += m.place;
    fit.mean_position += m.position;
  }
  const double share = 1.0 / static_cast<double>(markers.size());
  fit.mean_place *= share;
  fit.mean_position *= share;
  for (const MarkerPair& m : markers) {
    const Vector3d z = m.place - fit.mean_place;
    const Vector3d y = m.position - fit.mean_position;
    moments.zz += z * z.transpose();
    moments.yz += y * z.transpose();
  }
  return moments;
}

}  // namespace

AffineFit fit_affine(std::span<const MarkerPair> markers, const Matrix3d& A_predicted,
                     double lambda) noexcept {
  AffineFit fit;
  Moments moments = centred_moments(markers, fit);
  moments.yz += lambda * lambda * A_predicted;
  moments.zz.diagonal().array() += lambda * lambda;
  fit.A = moments.yz * moments.zz.inverse();
  return fit;
}

bool fit_rotation(std::span<const MarkerPair> markers, Matrix3d& R) noexcept {
  constexpr double kLine = 1e-4;  // m^2
  if (markers.size() < 3) return false;
  AffineFit fit;
  const Matrix3d yz = centred_moments(markers, fit).yz;
  const Eigen::JacobiSVD<Matrix3d> svd(yz, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()[1] > kLine)) return false;
  Vector3d signs = Vector3d::Ones();
  signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return true;
}

double marker_residual(std::span<const MarkerPair> markers, const Matrix3d& R,
                       const Vector3d& origin) noexcept {
  if (markers.empty()) return 0.0;
  double sum = 0.0;
  for (const MarkerPair& m : markers) sum += (origin + R * m.place - m.position).squaredNorm();
  return std::sqrt(sum / static_cast<double>(markers.size()));
}

}  // namespace footfall::engine
