// Propagation and corrections; see invariant_filter.h.
#include "engine/estimators/parts/invariant_filter.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <type_traits>

#include "core/index.h"

namespace footfall::engine {

template <int Feet>
void InvariantFilter<Feet>::start(const Matrix3d& R, const Vector3d& v,
                                  const Vector3d& p) noexcept {
  *this = {};
  R_ = R;
  v_ = v;
  p_ = p;
  feet_.fill(Vector3d::Zero());
}

template <int Feet>
void InvariantFilter<Feet>::set_deviation(Block block, const Vector3d& deviation) noexcept {
  P_.template block<3, 3>(block, block) = deviation.cwiseAbs2().asDiagonal();
}

template <int Feet>
void InvariantFilter<Feet>::propagate(const Vector3d& gyro, const Vector3d& accelerometer,
                                      double gravity, double dt) noexcept {
  const Vector3d turn = dt * (gyro - gyro_bias_);
  const Vector3d acceleration =
      R_ * (rotation_exp(0.5 * turn) * (accelerometer - accelerometer_bias_)) -
      Vector3d(0.0, 0.0, gravity);
  p_ += dt * v_ + 0.5 * dt * dt * acceleration;
  v_ += dt * acceleration;
  R_ = R_ * rotation_exp(turn);
}

// p̂ - p = xi_p - [p]x xi_R = 0.
template <int Feet>
void InvariantFilter<Feet>::tie_place(const Vector3d& p) noexcept {
  const Matrix3d S = skew(p);
  P_.template middleRows<3>(kP) = S * P_.template middleRows<3>(kR);
  P_.template middleCols<3>(kP) = P_.template middleRows<3>(kP).transpose();
  P_.template block<3, 3>(kP, kP) = S * P_.template block<3, 3>(kR, kR) * S.transpose();
}

// The gyroscope's error turns all errors about the origin: with B = -R dt,
//   xi_R += B zeta_g,  xi_x += x x (B zeta_g)  for x = v, p, d_i,
// and its white noise enters by the same map. With D the covariance's columns of zeta_g, G the map
// and S = P_gg + white noise:  P' = P + F Gᵀ + G Fᵀ,  F = D + G S / 2, by blocks of the lower half.
template <int Feet>
void InvariantFilter<Feet>::couple_gyro_bias(double variance, double dt) noexcept {
  constexpr int kBlocks = 3 + Feet;
  const Matrix3d B = -dt * R_;
  Matrix3d S = P_.template block<3, 3>(kGyroBias, kGyroBias);
  S.diagonal().array() += variance / (dt * dt);
  std::array<Matrix3d, kBlocks> G, F;
  std::array<bool, kBlocks> used;
  for (int k = 0; k < kBlocks; ++k) {
    used[at(k)] = k < 3 || has_foot_[at(k - 3)];
    if (!used[at(k)]) continue;
    const int row = kR + 3 * k;
    if (k == 0) {
      G[0] = B;
    } else {
      const Vector3d& x = k == 1 ? v_ : k == 2 ? p_ : feet_[at(k - 3)];
      for (int c = 0; c < 3; ++c) G[at(k)].col(c) = x.cross(B.col(c));
    }
    F[at(k)] = P_.template block<3, 3>(row, kGyroBias) + 0.5 * G[at(k)] * S;
  }
  for (int i = 0; i < kBlocks; ++i) {
    if (!used[at(i)]) continue;
    const int row = kR + 3 * i;
    for (int j = 0; j <= i; ++j) {
      if (!used[at(j)]) continue;
      const int column = kR + 3 * j;
      P_.template block<3, 3>(row, column) +=
          F[at(i)] * G[at(j)].transpose() + G[at(i)] * F[at(j)].transpose();
      if (i != j) {
        P_.template block<3, 3>(column, row) = P_.template block<3, 3>(row, column).transpose();
      }
    }
  }
  const Matrix3d Pgg = P_.template block<3, 3>(kGyroBias, kGyroBias);
  const Matrix3d Pga = P_.template block<3, 3>(kGyroBias, kAccelerometerBias);
  for (int i = 0; i < kBlocks; ++i) {
    if (!used[at(i)]) continue;
    const int row = kR + 3 * i;
    way_with_error_.template middleCols<3>(row) +=
        way_with_error_.template middleCols<3>(kGyroBias) * G[at(i)].transpose();
    P_.template block<3, 3>(row, kGyroBias) += G[at(i)] * Pgg;
    P_.template block<3, 3>(row, kAccelerometerBias) += G[at(i)] * Pga;
    P_.template block<3, 3>(kGyroBias, row) = P_.template block<3, 3>(row, kGyroBias).transpose();
    P_.template block<3, 3>(kAccelerometerBias, row) =
        P_.template block<3, 3>(row, kAccelerometerBias).transpose();
  }
}

// Elementary steps in turn, each on rows and columns:
//   xi_p += dt xi_v;  xi_v += dt (g x xi_R - R zeta_a);  the gyroscope's part.
template <int Feet>
void InvariantFilter<Feet>::propagate_covariance(const InvariantNoise& noise, double gravity,
                                                 double dt) noexcept {
  P_.template middleRows<3>(kP) += dt * P_.template middleRows<3>(kV);
  P_.template middleCols<3>(kP) += dt * P_.template middleCols<3>(kV);
  WayRows& way = way_with_error_;
  way.template middleCols<3>(kP) += dt * way.template middleCols<3>(kV);

  Matrix3d from_R = Matrix3d::Zero();  // dt [g]x, g = (0, 0, -gravity)
  from_R(0, 1) = dt * gravity;
  from_R(1, 0) = -dt * gravity;
  const Matrix3d from_bias = -dt * R_;
  Eigen::Matrix<double, kSize, 3> columns =
      P_.template middleCols<3>(kR) * from_R.transpose() +
      P_.template middleCols<3>(kAccelerometerBias) * from_bias.transpose();
  const Matrix3d own = from_R * columns.template middleRows<3>(kR) +
                       from_bias * columns.template middleRows<3>(kAccelerometerBias);
  P_.template middleCols<3>(kV) += columns;
  P_.template middleRows<3>(kV) += columns.transpose();
  P_.template block<3, 3>(kV, kV) += own;
  way.template middleCols<3>(kV) +=
      way.template middleCols<3>(kR) * from_R.transpose() +
      way.template middleCols<3>(kAccelerometerBias) * from_bias.transpose();

  const double sample = noise.sample;
  couple_gyro_bias(noise.gyro * noise.gyro * sample * dt, dt);
  P_.template block<3, 3>(kV, kV).diagonal().array() +=
      noise.accelerometer * noise.accelerometer * sample * dt;
  P_.diagonal().template segment<3>(kGyroBias).array() +=
      noise.gyro_bias_walk * noise.gyro_bias_walk * dt;
  P_.diagonal().template segment<3>(kAccelerometerBias).array() +=
      noise.accelerometer_bias_walk * noise.accelerometer_bias_walk * dt;
  for (int i = 0; i < Feet; ++i) {
    if (!has_foot_[at(i)]) continue;
    P_.diagonal().template segment<3>(kFeet + 3 * i).array() += noise.slip * noise.slip * dt;
  }
}

// d = p + R h + noise, so that xi_d = xi_p + noise: the covariance's rows are those of p.
template <int Feet>
void InvariantFilter<Feet>::add_foot(int i, const Vector3d& h, double deviation) noexcept {
  const int row = kFeet + 3 * i;
  drop_foot(i);
  has_foot_[at(i)] = true;
  feet_[at(i)] = p_ + R_ * h;
  P_.template middleRows<3>(row) = P_.template middleRows<3>(kP);
  P_.template middleCols<3>(row) = P_.template middleCols<3>(kP);
  P_.template block<3, 3>(row, row) = P_.template block<3, 3>(kP, kP);
  P_.template block<3, 3>(row, row).diagonal().array() += deviation * deviation;
  way_with_error_.template middleCols<3>(row) = way_with_error_.template middleCols<3>(kP);
}

template <int Feet>
void InvariantFilter<Feet>::drop_foot(int i) noexcept {
  const int row = kFeet + 3 * i;
  has_foot_[at(i)] = false;
  P_.template middleRows<3>(row).setZero();
  P_.template middleCols<3>(row).setZero();
  way_with_error_.template middleCols<3>(row).setZero();
}

// For x = p, d: x̂ - c - exp([xi_R]x) (x - c) = xi_x - [c]x xi_R to first order moves the origin to
// c. Then p̂ - p = xi_p - [p]x xi_R is taken out of all places, horizontally, and added to the way's
// error.
template <int Feet>
Vector3d InvariantFilter<Feet>::anchor() noexcept {
  const Vector3d c(p_[0], p_[1], 0.0);
  std::array<int, Feet + 1> places{kP};
  int count = 1;
  for (int i = 0; i < Feet; ++i) {
    if (!has_foot(i)) continue;
    feet_[at(i)] -= c;
    places[at(count++)] = kFeet + 3 * i;
  }
  p_ -= c;
  const Matrix3d S = skew(c), here = skew(p_);
  // On the columns of M; returns those of p̂ - p.
  const auto move_columns = [&](auto& M) {
    using Columns =
        Eigen::Matrix<double, std::remove_reference_t<decltype(M)>::RowsAtCompileTime, 2>;
    for (int k = 0; k < count; ++k) {
      M.template middleCols<3>(places[at(k)]) -= M.template middleCols<3>(kR) * S.transpose();
    }
    const Columns place = M.template middleCols<2>(kP) -
                          M.template middleCols<3>(kR) * here.template topRows<2>().transpose();
    for (int k = 0; k < count; ++k) M.template middleCols<2>(places[at(k)]) -= place;
    return place;
  };
  for (int k = 0; k < count; ++k) {
    P_.template middleRows<3>(places[at(k)]) -= S * P_.template middleRows<3>(kR);
  }
  WayRows rows =
      P_.template middleRows<2>(kP) - here.template topRows<2>() * P_.template middleRows<3>(kR);
  for (int k = 0; k < count; ++k) P_.template middleRows<2>(places[at(k)]) -= rows;
  move_columns(P_);
  const Eigen::Matrix2d with_way = move_columns(way_with_error_);
  way_ += with_way + with_way.transpose() + move_columns(rows);
  way_with_error_ += rows;
  return c;
}

// x = exp(-xi) x̂ with xi the gain times the residual; P -= L Lᵀ is done by the caller.
template <int Feet>
void InvariantFilter<Feet>::add_error(const Error& error) noexcept {
  const Vector3d turn = error.template segment<3>(kR);
  const Matrix3d E = rotation_exp(turn);
  const Matrix3d J = left_jacobian(turn);
  R_ = E * R_;
  v_ = E * v_ + J * error.template segment<3>(kV);
  p_ = E * p_ + J * error.template segment<3>(kP);
  for (int i = 0; i < Feet; ++i) {
    if (has_foot_[at(i)]) {
      feet_[at(i)] = E * feet_[at(i)] + J * error.template segment<3>(kFeet + 3 * i);
    }
  }
  gyro_bias_ += error.template segment<3>(kGyroBias);
  accelerometer_bias_ += error.template segment<3>(kAccelerometerBias);
}

template <int Feet>
double InvariantFilter<Feet>::correct_by_foot(int i, const Vector3d& h, double deviation,
                                              double gate) noexcept {
  const int row = kFeet + 3 * i;
  const Vector3d residual = R_ * h - (feet_[at(i)] - p_);
  const Eigen::Matrix<double, kSize, 3> PHt =
      P_.template middleCols<3>(kP) - P_.template middleCols<3>(row);
  Matrix3d S = PHt.template middleRows<3>(kP) - PHt.template middleRows<3>(row);
  S.diagonal().array() += deviation * deviation;
  const Eigen::LLT<Matrix3d> factor(S);
  const Matrix3d L = factor.matrixL();
  // S^-1 = Wᵀ W with W = L^-1.
  Matrix3d W = Matrix3d::Identity();
  L.template triangularView<Eigen::Lower>().solveInPlace(W);
  const Vector3d whitened = W * residual;
  if (gate > 0.0 && whitened.squaredNorm() > gate * gate) return -residual.norm();
  const Eigen::Matrix<double, kSize, 3> gain = PHt * W.transpose();
  add_error(-(gain * whitened));
  P_.noalias() -= gain.lazyProduct(gain.transpose());
  const Eigen::Matrix<double, 2, 3> way =
      (way_with_error_.template middleCols<3>(kP) - way_with_error_.template middleCols<3>(row)) *
      W.transpose();
  way_with_error_.noalias() -= way.lazyProduct(gain.transpose());
  return residual.norm();
}

// z of d̂ - d = xi_d + xi_R x d to first order.
template <int Feet>
void InvariantFilter<Feet>::correct_height(int i, double z, double deviation) noexcept {
  const int row = kFeet + 3 * i;
  const Vector3d& d = feet_[at(i)];
  const Error PHt = P_.col(row + 2) + d[1] * P_.col(kR) - d[0] * P_.col(kR + 1);
  const double S = PHt[row + 2] + d[1] * PHt[kR] - d[0] * PHt[kR + 1] + deviation * deviation;
  const double residual = d[2] - z;
  add_error(-(residual / S) * PHt);
  P_.noalias() -= (PHt / S) * PHt.transpose();
  const Eigen::Vector2d way = way_with_error_.col(row + 2) + d[1] * way_with_error_.col(kR) -
                              d[0] * way_with_error_.col(kR + 1);
  way_with_error_.noalias() -= (way / S) * PHt.transpose();
}

template class InvariantFilter<2>;
template class InvariantFilter<4>;
template class InvariantFilter<8>;

}  // namespace footfall::engine
