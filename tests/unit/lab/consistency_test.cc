// Normalised errors of a filter whose covariance is known exactly.
#include "lab/replay/consistency.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace footfall::tests {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

// Roll, pitch and velocity with errors of covariance Q, and a heading that is off by `heading`.
class KnownFilter {
 public:
  explicit KnownFilter(double heading) : heading_(heading) {
    Matrix5 root = Matrix5::Zero();
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j <= i; ++j) root(i, j) = (i < 2 ? 2e-3 : 2e-2) * normal_(random_);
      root(i, i) += i < 2 ? 4e-3 : 4e-2;
    }
    root_ = root;
  }

  // `scale`: of the errors against those that the covariance tells.
  lab::NormalisedError draw(double scale) {
    Vector5 error;
    for (int i = 0; i < 5; ++i) error[i] = normal_(random_);
    error = scale * root_ * error;
    const Eigen::Quaterniond R(Eigen::AngleAxisd(normal_(random_), Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(0.2 * normal_(random_), Eigen::Vector3d::UnitX()));
    const Eigen::Vector3d v(0.3 * normal_(random_), 0.3 * normal_(random_), 0.1);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(heading_, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d tilt(error[0], error[1], 0.0);
    const Eigen::Quaterniond off(Eigen::AngleAxisd(tilt.norm(), tilt.normalized()));
    const Eigen::Vector3d v_hat = turn * v + error.tail<3>();
    return lab::normalised_error(state(off * turn * R, v_hat), state(R, v), told(v_hat));
  }

 private:
  static model::State state(const Eigen::Quaterniond& q, const Eigen::Vector3d& v) {
    model::State s;
    s.q_WB = {q.w(), q.x(), q.y(), q.z()};
    s.v_WB = {v[0], v[1], v[2]};
    return s;
  }

  // The heading's error xi adds xi z x v to that of the velocity; place is of no account.
  engine::ErrorCovariance told(const Eigen::Vector3d& v) const {
    constexpr double kHeading = 0.3;
    Eigen::Matrix<double, 9, 6> map = Eigen::Matrix<double, 9, 6>::Zero();
    map(0, 0) = map(1, 1) = 1.0;
    map.block<3, 3>(3, 2).setIdentity();
    map(2, 5) = kHeading;
    map.block<3, 1>(3, 5) = kHeading * Eigen::Vector3d::UnitZ().cross(v);
    Eigen::Matrix<double, 6, 6> P = Eigen::Matrix<double, 6, 6>::Identity();
    P.topLeftCorner<5, 5>() = root_ * root_.transpose();
    engine::ErrorCovariance out;
    Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>>(out.data()) =
        map * P * map.transpose();
    return out;
  }

  double heading_;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
  Matrix5 root_;
};

constexpr int kDraws = 4000;

double mean_of_draws(KnownFilter filter, double scale,
                     double lab::NormalisedError::*part = &lab::NormalisedError::all) {
  lab::NeesFigure figure;
  for (int k = 0; k < kDraws; ++k) figure.add(filter.draw(scale).*part);
  return figure.mean();
}

// A chi-square with n degrees of freedom has the mean n and the variance 2 n.
TEST(NormalisedError, OfAConsistentFilterIsItsDimensionInTheMean) {
  const double n = lab::kNeesDimension;
  const double tolerance = 4.0 * std::sqrt(2.0 * n / kDraws);
  EXPECT_NEAR(mean_of_draws(KnownFilter(0.0), 1.0), n, tolerance);
  EXPECT_NEAR(mean_of_draws(KnownFilter(0.0), 2.0), 4.0 * n, 4.0 * tolerance);
}

TEST(NormalisedError, OfItsPartsIsTheirDimension) {
  EXPECT_NEAR(mean_of_draws(KnownFilter(0.0), 1.0, &lab::NormalisedError::tilt), 2.0,
              4.0 * std::sqrt(4.0 / kDraws));
  EXPECT_NEAR(mean_of_draws(KnownFilter(0.0), 1.0, &lab::NormalisedError::velocity), 3.0,
              4.0 * std::sqrt(6.0 / kDraws));
}

TEST(NormalisedError, DoesNotDependOnTheHeadingsError) {
  const double n = lab::kNeesDimension;
  EXPECT_NEAR(mean_of_draws(KnownFilter(1.5), 1.0), n, 4.0 * std::sqrt(2.0 * n / kDraws));
  EXPECT_NEAR(mean_of_draws(KnownFilter(-3.0), 1.0), n, 4.0 * std::sqrt(2.0 * n / kDraws));
}

TEST(NormalisedError, IsNoNumberWithoutACovariance) {
  EXPECT_TRUE(std::isnan(lab::normalised_error({}, {}, {}).all));
}

// The truth starts at (3, 4), heading 90 degrees, and goes on by 2 m; the estimator starts at its
// origin. Told 2 m ahead and 0.2 m aside, with deviations of 0.1 m and 0.1 m, that is 4.
TEST(NormalisedError, OfThePlaceIsInTheEstimatorsOwnWorld) {
  model::State start, truth, estimate;
  start.p_WB = {3, 4, 0.8};
  start.q_WB = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  truth = start;
  truth.p_WB = {3, 6, 0.8};
  estimate.p_WB = {2.0, 0.2, 0.8};
  engine::ErrorCovariance covariance{};
  covariance[9 * 6 + 6] = covariance[9 * 7 + 7] = 0.01;
  EXPECT_NEAR(lab::StartFrame({}, start).normalised_place(estimate, truth, covariance), 4.0, 1e-9);
}

}  // namespace
}  // namespace footfall::tests
