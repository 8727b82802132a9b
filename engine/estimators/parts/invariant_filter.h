// Right-invariant extended Kalman filter of a base with feet that keep their places (Hartley,
// Ghaffari, Eustice, Grizzle 2019: "Contact-aided invariant extended Kalman filtering").
//
// State: R (base axes in the world), v and p (velocity and position of the IMU, world), d_i (places
// of the feet, world), b_g and b_a (biases in base axes). Error, all in world axes, of an estimate
// with hats:
//   exp([xi_R]x) = R̂ Rᵀ,  xi_x = x̂ - exp([xi_R]x) x  for x = v, p, d_i,  zeta = b̂ - b
// Its propagation and the feet's measurement do not depend on the estimate but for the biases, so
// that heading and place stay unobservable in the filter as they are in truth.
#pragma once

#include <Eigen/Core>
#include <array>

#include "engine/estimators/parts/rotation.h"

namespace footfall::engine {

// Noise of a step. Random walks are told as the standard deviation that they reach in 1 s.
struct InvariantNoise {
  double gyro = 0.0;                     // rad/s, of a sample
  double accelerometer = 0.0;            // m/s^2, of a sample
  double gyro_bias_walk = 0.0;           // rad/s
  double accelerometer_bias_walk = 0.0;  // m/s^2
  double slip = 0.0;                     // m, of a foot's place
  double sample = 0.0;                   // s, that a sample is the mean over
};

template <int Feet>
class InvariantFilter {
 public:
  static constexpr int kSize = 15 + 3 * Feet;
  // First rows of the error's blocks; foot i: kFeet + 3 i.
  enum Block { kGyroBias = 0, kAccelerometerBias = 3, kR = 6, kV = 9, kP = 12, kFeet = 15 };
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  using Error = Eigen::Matrix<double, kSize, 1>;
  using WayRows = Eigen::Matrix<double, 2, kSize>;

  // Without feet; a diagonal covariance of the base.
  void start(const Matrix3d& R, const Vector3d& v, const Vector3d& p) noexcept;
  void set_deviation(Block block, const Vector3d& deviation) noexcept;
  // The base at `p` is where the world is told from: no error of attitude moves it. For a start,
  // after the attitude's deviation.
  void tie_place(const Vector3d& p) noexcept;

  // Over dt with mean rate and specific force, both measured, base axes.
  void propagate(const Vector3d& gyro, const Vector3d& accelerometer, double gravity,
                 double dt) noexcept;
  // The covariance over dt at the present estimate, to first order in dt.
  void propagate_covariance(const InvariantNoise& noise, double gravity, double dt) noexcept;

  bool has_foot(int i) const noexcept { return has_foot_[static_cast<std::size_t>(i)]; }
  // A foot at h from the IMU (base axes, m) with a deviation on each axis from now on keeps its
  // place.
  void add_foot(int i, const Vector3d& h, double deviation) noexcept;
  void drop_foot(int i) noexcept;
  // Puts the world's origin where the base truly is, horizontally: the base's place becomes the
  // origin without error, a foot's error what it was relative to the base. Place is not observable,
  // so that nothing is lost; but with the origin far away each correction of heading, which turns
  // the estimate about it, would move the base and the feet. Returns the base's place before. What
  // errors these places had, summed up, is the error e of the way; corrections do not change the
  // way (Schmidt: a state that is considered), but e goes on depending on the error's other parts.
  Vector3d anchor() noexcept;
  void move_foot(int i, const Vector3d& shift) noexcept {
    feet_[static_cast<std::size_t>(i)] += shift;
  }
  // r = R̂ h - (d̂ - p̂) = xi_p - xi_d + noise. Returns |r|, m. Beyond `gate` standard deviations
  // nothing is corrected and the result is negative; 0: no gate.
  double correct_by_foot(int i, const Vector3d& h, double deviation, double gate) noexcept;
  // The foot's place has the height z, m.
  void correct_height(int i, double z, double deviation) noexcept;

  const Matrix3d& R() const noexcept { return R_; }
  const Vector3d& v() const noexcept { return v_; }
  const Vector3d& p() const noexcept { return p_; }
  const Vector3d& foot(int i) const noexcept { return feet_[static_cast<std::size_t>(i)]; }
  const Vector3d& gyro_bias() const noexcept { return gyro_bias_; }
  const Vector3d& accelerometer_bias() const noexcept { return accelerometer_bias_; }
  const Covariance& covariance() const noexcept { return P_; }
  // Of the way's error e, x and y in m: with the error, and its own.
  const WayRows& way_with_error() const noexcept { return way_with_error_; }
  const Eigen::Matrix2d& way_covariance() const noexcept { return way_; }
  // For tests: the covariance, and the estimate moved by an error, x̂ = exp(xi) x.
  Covariance& covariance() noexcept { return P_; }
  void add_error(const Error& error) noexcept;

 private:
  template <int Rows>
  void apply(const Eigen::Matrix<double, kSize, Rows>& gain,
             const Eigen::Matrix<double, Rows, 1>& residual) noexcept;
  void couple_gyro_bias(double variance, double dt) noexcept;

  Matrix3d R_ = Matrix3d::Identity();
  Vector3d v_ = Vector3d::Zero(), p_ = Vector3d::Zero();
  Vector3d gyro_bias_ = Vector3d::Zero(), accelerometer_bias_ = Vector3d::Zero();
  std::array<Vector3d, Feet> feet_{};
  std::array<bool, Feet> has_foot_{};
  Covariance P_ = Covariance::Zero();
  WayRows way_with_error_ = WayRows::Zero();
  Eigen::Matrix2d way_ = Eigen::Matrix2d::Zero();
};

extern template class InvariantFilter<2>;
extern template class InvariantFilter<4>;
extern template class InvariantFilter<8>;

}  // namespace footfall::engine
