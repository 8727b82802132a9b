// The filter's linear maps against finite differences, its corrections against the dense equations,
// and its covariance against errors drawn many times.
#include "engine/estimators/parts/invariant_filter.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "core/random.h"
#include "tests/support/matrix.h"

namespace footfall::tests {
namespace {

using engine::Matrix3d;
using engine::Vector3d;
using Filter = engine::InvariantFilter<2>;
using Error = Filter::Error;
using Covariance = Filter::Covariance;

constexpr double kGravity = 9.81;

// Of an estimate against the truth, by the definition in the header.
Error error_of(const Filter& estimate, const Filter& truth) {
  Error e = Error::Zero();
  const Matrix3d turn = estimate.R() * truth.R().transpose();
  const Vector3d xi = engine::rotation_log(turn);
  const Matrix3d J_inverse = engine::left_jacobian(xi).inverse();
  e.segment<3>(Filter::kR) = xi;
  e.segment<3>(Filter::kV) = J_inverse * (estimate.v() - turn * truth.v());
  e.segment<3>(Filter::kP) = J_inverse * (estimate.p() - turn * truth.p());
  for (int i = 0; i < 2; ++i) {
    e.segment<3>(Filter::kFeet + 3 * i) = J_inverse * (estimate.foot(i) - turn * truth.foot(i));
  }
  e.segment<3>(Filter::kGyroBias) = estimate.gyro_bias() - truth.gyro_bias();
  e.segment<3>(Filter::kAccelerometerBias) =
      estimate.accelerometer_bias() - truth.accelerometer_bias();
  return e;
}

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  Vector3d vector(double deviation) {
    const double x = normal_(engine_), y = normal_(engine_), z = normal_(engine_);
    return deviation * Vector3d(x, y, z);
  }
  Error error() {
    Error e;
    for (double& x : e) x = normal_(engine_);
    return e;
  }
  Covariance covariance() {
    Covariance M;
    for (double& x : M.reshaped()) x = normal_(engine_);
    const Matrix P = 1e-3 * dense(M) * dense(M).transpose();
    return Covariance((0.5 * (P + P.transpose())).data());
  }

 private:
  std::mt19937_64 engine_;
  core::Normal normal_;
};

Filter moving(Draw& draw) {
  Filter f;
  f.start(engine::rotation_exp(draw.vector(0.5)), draw.vector(0.5), draw.vector(1.0));
  f.add_foot(0, draw.vector(0.5), 0.0);
  f.add_foot(1, draw.vector(0.5), 0.0);
  Error bias = Error::Zero();
  bias.segment<3>(Filter::kGyroBias) = draw.vector(0.1);
  bias.segment<3>(Filter::kAccelerometerBias) = draw.vector(0.1);
  f.add_error(bias);
  f.covariance() = draw.covariance();
  return f;
}

TEST(InvariantFilter, TheErrorThatIsAddedIsTheErrorThatIsThere) {
  Draw draw(1);
  const Filter truth = moving(draw);
  const Error error = 0.1 * draw.error();
  Filter estimate = truth;
  estimate.add_error(error);
  EXPECT_LT((error_of(estimate, truth) - error).norm(), 1e-12);
}

// F: the error of a propagated estimate against the propagated truth, column by column; the
// covariance follows it to first order in dt.
TEST(InvariantFilter, TheCovarianceIsPropagatedByTheErrorsOwnMap) {
  constexpr double kStep = 1e-5, kSize = 1e-6;
  Draw draw(2);
  const Filter truth = moving(draw);
  const Vector3d gyro = draw.vector(1.0), force = draw.vector(5.0) + Vector3d(0, 0, kGravity);
  Filter moved = truth;
  moved.propagate(gyro, force, kGravity, kStep);
  Covariance F;
  for (int k = 0; k < Filter::kSize; ++k) {
    Error error = Error::Zero();
    error[k] = kSize;
    Filter plus = truth, minus = truth;
    plus.add_error(error);
    minus.add_error(-error);
    plus.propagate(gyro, force, kGravity, kStep);
    minus.propagate(gyro, force, kGravity, kStep);
    F.col(k) = (error_of(plus, moved) - error_of(minus, moved)) / (2.0 * kSize);
  }
  const engine::InvariantNoise noise{};
  Filter filter = truth;
  filter.propagate_covariance(noise, kGravity, kStep);
  const Covariance change = (filter.covariance() - truth.covariance()) / kStep;
  const Matrix P = dense(truth.covariance());
  const Matrix expected = (dense(F) * P * dense(F).transpose() - P) / kStep;
  // Second order: dt times squares of F's entries (at most 1e2) times the covariance's (3e-2).
  EXPECT_LT((dense(change) - expected).max_abs(), 1e-3 * expected.max_abs());
  EXPECT_EQ(filter.covariance(), filter.covariance().transpose());
}

TEST(InvariantFilter, NoiseEntersByTheSameMap) {
  Draw draw(3);
  Filter f = moving(draw);
  f.covariance().setZero();
  const engine::InvariantNoise noise{.gyro = 0.1,
                                     .accelerometer = 0.2,
                                     .gyro_bias_walk = 0.3,
                                     .accelerometer_bias_walk = 0.4,
                                     .slip = 0.5,
                                     .sample = 1e-3};
  const double dt = 2e-3;
  const Matrix3d R = f.R();
  Eigen::Matrix<double, Filter::kSize, 3> by_gyro = Eigen::Matrix<double, Filter::kSize, 3>::Zero();
  by_gyro.middleRows<3>(Filter::kR) = R;
  by_gyro.middleRows<3>(Filter::kV) = engine::skew(f.v()) * R;
  by_gyro.middleRows<3>(Filter::kP) = engine::skew(f.p()) * R;
  for (int i = 0; i < 2; ++i) {
    by_gyro.middleRows<3>(Filter::kFeet + 3 * i) = engine::skew(f.foot(i)) * R;
  }
  const Matrix turned = 0.1 * 0.1 * 1e-3 * dt * dense(by_gyro) * dense(by_gyro).transpose();
  Covariance expected(turned.data());
  expected.diagonal().segment<3>(Filter::kV).array() += 0.2 * 0.2 * 1e-3 * dt;
  expected.diagonal().segment<3>(Filter::kGyroBias).array() += 0.3 * 0.3 * dt;
  expected.diagonal().segment<3>(Filter::kAccelerometerBias).array() += 0.4 * 0.4 * dt;
  expected.diagonal().segment<6>(Filter::kFeet).array() += 0.5 * 0.5 * dt;
  f.propagate_covariance(noise, kGravity, dt);
  EXPECT_LT((f.covariance() - expected).cwiseAbs().maxCoeff(), 1e-15);
}

// H by differences of r = R̂ h - (d̂ - p̂), then the dense Kalman equations.
TEST(InvariantFilter, AFootCorrectsAsTheDenseEquationsDo) {
  constexpr double kSize = 1e-6;
  Draw draw(4);
  const Filter truth = moving(draw);
  const Vector3d h = truth.R().transpose() * (truth.foot(1) - truth.p());
  const auto residual = [&](const Filter& f) -> Vector3d {
    return f.R() * h - (f.foot(1) - f.p());
  };
  Eigen::Matrix<double, 3, Filter::kSize> H;
  for (int k = 0; k < Filter::kSize; ++k) {
    Error error = Error::Zero();
    error[k] = kSize;
    Filter plus = truth, minus = truth;
    plus.add_error(error);
    minus.add_error(-error);
    H.col(k) = (residual(plus) - residual(minus)) / (2.0 * kSize);
  }
  Filter f = truth;
  f.add_error(1e-3 * draw.error());
  const Filter before = f;
  const Matrix P = dense(f.covariance()), Ht = dense(H).transpose();
  const Matrix S = dense(H) * P * Ht + 0.01 * 0.01 * Matrix::identity(3);
  const Matrix K = P * Ht * inverse(S);
  f.correct_by_foot(1, h, 0.01, 0.0);
  EXPECT_LT((dense(error_of(f, before)) + K * dense(residual(before))).norm(), 1e-7);
  EXPECT_LT((dense(f.covariance()) - (P - K * dense(H) * P)).norm(), 1e-8);
}

TEST(InvariantFilter, AHeightCorrectsAsTheDenseEquationsDo) {
  constexpr double kSize = 1e-6;
  Draw draw(5);
  const Filter truth = moving(draw);
  Eigen::Matrix<double, 1, Filter::kSize> H;
  for (int k = 0; k < Filter::kSize; ++k) {
    Error error = Error::Zero();
    error[k] = kSize;
    Filter plus = truth, minus = truth;
    plus.add_error(error);
    minus.add_error(-error);
    H[k] = (plus.foot(0)[2] - minus.foot(0)[2]) / (2.0 * kSize);
  }
  Filter f = truth;
  const Matrix P = dense(f.covariance()), Ht = dense(H).transpose();
  const double S = dot(Ht, P * Ht) + 0.02 * 0.02;
  const Matrix K = P * Ht / S;
  const double z = truth.foot(0)[2] - 1e-3;
  f.correct_height(0, z, 0.02);
  EXPECT_LT((dense(error_of(f, truth)) + 1e-3 * K).norm(), 1e-7);
  EXPECT_LT((dense(f.covariance()) - (P - K * dense(H) * P)).norm(), 1e-8);
}

TEST(InvariantFilter, AFootBeyondTheGateIsToldAndNotUsed) {
  Draw draw(6);
  Filter f;
  f.start(Matrix3d::Identity(), Vector3d::Zero(), Vector3d(0, 0, 1));
  f.add_foot(0, {0, 0, -1}, 1e-3);
  EXPECT_LT(f.correct_by_foot(0, {0.02, 0, -1}, 1e-3, 6.0), 0.0);
  EXPECT_EQ(f.p()[0], 0.0);
  EXPECT_GT(f.correct_by_foot(0, {0.002, 0, -1}, 1e-3, 6.0), 0.0);
  EXPECT_NE(f.foot(0)[0], 0.0);
}

// Heading and place cannot be seen: a turn about the vertical and a shift of everything leave every
// measurement as it is, and the filter keeps their deviation whatever it measures.
TEST(InvariantFilter, HeadingAndPlaceStayUncertain) {
  Draw draw(7);
  Filter f;
  f.start(Matrix3d::Identity(), Vector3d::Zero(), Vector3d(0, 0, 1));
  f.set_deviation(Filter::kR, {0.05, 0.05, 0.1});
  f.set_deviation(Filter::kP, {0.2, 0.2, 0.2});
  f.set_deviation(Filter::kV, {0.1, 0.1, 0.1});
  f.add_foot(0, {0.0, 0.1, -1}, 1e-3);
  f.add_foot(1, {0.0, -0.1, -1}, 1e-3);
  const engine::InvariantNoise noise{.gyro = 0.01, .accelerometer = 0.1, .sample = 1e-3};
  for (int i = 0; i < 3000; ++i) {
    f.propagate(Vector3d(0.1, 0.2, 0.3), Vector3d(0, 0, kGravity), kGravity, 1e-3);
    f.propagate_covariance(noise, kGravity, 1e-3);
    for (int foot = 0; foot < 2; ++foot) {
      f.correct_by_foot(foot, f.R().transpose() * (f.foot(foot) - f.p()) + draw.vector(1e-3), 1e-3,
                        0.0);
    }
    // Two feet see the gyroscope's noise about the vertical, not the heading at the start.
    ASSERT_GT(f.covariance()(Filter::kR + 2, Filter::kR + 2), 0.1 * 0.1 * (1.0 - 1e-9));
  }
  EXPECT_LT(std::sqrt(f.covariance()(Filter::kR, Filter::kR)), 0.01);
  for (int k = 0; k < 2; ++k) {
    EXPECT_GT(std::sqrt(f.covariance()(Filter::kP + k, Filter::kP + k)), 0.19);
  }
}

// The estimate and the truth each put their base at the origin; the covariance follows that map of
// the error, column by column. What a foot's place relative to the base may be wrong by stays.
TEST(InvariantFilter, AnchoringTakesTheBasesPlaceOutOfTheErrorAndNothingElse) {
  constexpr double kSize = 1e-6;
  Draw draw(9);
  const Filter truth = moving(draw);
  Filter anchored = truth;
  EXPECT_EQ(anchored.anchor(), Vector3d(truth.p()[0], truth.p()[1], 0.0));
  Covariance T;
  for (int k = 0; k < Filter::kSize; ++k) {
    Error error = Error::Zero();
    error[k] = kSize;
    Filter plus = truth, minus = truth;
    plus.add_error(error);
    minus.add_error(-error);
    plus.anchor();
    minus.anchor();
    T.col(k) = (error_of(plus, anchored) - error_of(minus, anchored)) / (2.0 * kSize);
  }
  Filter filter = truth;
  filter.anchor();
  const Covariance expected = T * truth.covariance() * T.transpose();
  // Second order of the differences: 1e-12 / 1e-6; places of 1 m, entries of 0.1.
  EXPECT_LT((filter.covariance() - expected).cwiseAbs().maxCoeff(), 1e-7);
  // p̂ - p = xi_p + xi_R x p: nothing is left of it.
  const Eigen::Matrix<double, 2, Filter::kSize> error_of_place =
      filter.covariance().middleRows<2>(Filter::kP) -
      engine::skew(filter.p()).topRows<2>() * filter.covariance().middleRows<3>(Filter::kR);
  EXPECT_LT(error_of_place.norm(), 1e-12);
  const Matrix3d S = engine::skew(truth.p());
  const auto& P = truth.covariance();
  const Matrix3d place = P.block<3, 3>(Filter::kP, Filter::kP) -
                         S * P.block<3, 3>(Filter::kR, Filter::kP) -
                         P.block<3, 3>(Filter::kP, Filter::kR) * S.transpose() +
                         S * P.block<3, 3>(Filter::kR, Filter::kR) * S.transpose();
  EXPECT_LT((filter.way_covariance() - place.topLeftCorner<2, 2>()).norm(), 1e-12);
  EXPECT_LT((filter.foot(1) - filter.p() - (truth.foot(1) - truth.p())).norm(), 1e-12);
}

// A heading that is wrong by a constant turns the whole way, however often the world is anchored:
// the deviation across is that of the heading times the distance.
TEST(InvariantFilter, AWrongHeadingTurnsTheWholeWay) {
  constexpr double kHeading = 0.02, kSpeed = 0.5, kDt = 2e-3;  // rad, m/s, s
  for (const int steps : {1, 10, 100}) {
    Filter f;
    f.start(Matrix3d::Identity(), Vector3d(kSpeed, 0, 0), Vector3d(0, 0, 1));
    // No error xi_v of its own: the velocity is known in the base's axes and turns with the
    // heading.
    f.set_deviation(Filter::kR, Vector3d(0, 0, kHeading));
    f.tie_place(f.p());
    for (int k = 1; k <= 1000; ++k) {
      f.propagate(Vector3d::Zero(), Vector3d(0, 0, kGravity), kGravity, kDt);
      f.propagate_covariance({.sample = kDt}, kGravity, kDt);
      if (k % (1000 / steps) == 0) f.anchor();
    }
    EXPECT_NEAR(std::sqrt(f.way_covariance()(1, 1)), kHeading * kSpeed * 2.0, 1e-9) << steps;
    EXPECT_NEAR(f.way_covariance()(0, 0), 0.0, 1e-12) << steps;
  }
}

// Errors drawn as the filter believes them: the squared error over the covariance (NEES) has the
// mean of its dimension, 21, with a deviation of sqrt(2 * 21 / runs).
TEST(InvariantFilter, TheCovarianceIsThatOfTheErrors) {
  constexpr int kRuns = 100, kTicks = 250;
  constexpr double kDt = 2e-3;
  const engine::InvariantNoise noise{.gyro = 0.01,
                                     .accelerometer = 0.1,
                                     .gyro_bias_walk = 1e-3,
                                     .accelerometer_bias_walk = 1e-2,
                                     .slip = 2e-3,
                                     .sample = kDt};
  Draw draw(8);
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Filter truth;
    truth.start(Matrix3d::Identity(), Vector3d(0.1, 0, 0), Vector3d(0, 0, 1));
    Filter f = truth;
    const auto spread = [&](Filter::Block block, double deviation) {
      f.set_deviation(block, deviation * Vector3d::Ones());
      Error error = Error::Zero();
      error.segment<3>(block) = draw.vector(deviation);
      return error;
    };
    const Error start = spread(Filter::kGyroBias, 0.01) + spread(Filter::kAccelerometerBias, 0.05) +
                        spread(Filter::kR, 0.02) + spread(Filter::kV, 0.05) +
                        spread(Filter::kP, 0.01);
    f.add_error(start);
    for (int foot = 0; foot < 2; ++foot) {
      const Vector3d h(0.0, foot == 0 ? 0.1 : -0.1, -1.0);
      truth.add_foot(foot, h, 0.0);
      f.add_foot(foot, h + draw.vector(1e-3), 1e-3);
    }
    for (int i = 0; i < kTicks; ++i) {
      const double t = i * kDt;
      // Measured: true motion, the truth's biases, and noise; biases and feet of the truth wander.
      const Vector3d w = 0.3 * Vector3d(std::sin(9 * t), std::cos(7 * t), std::sin(5 * t));
      const Vector3d force =
          truth.R().transpose() * (Vector3d(std::cos(8 * t), std::sin(6 * t), kGravity));
      const Vector3d gyro = w + truth.gyro_bias();
      const Vector3d accelerometer = force + truth.accelerometer_bias();
      f.propagate_covariance(noise, kGravity, kDt);
      f.propagate(gyro + draw.vector(noise.gyro), accelerometer + draw.vector(noise.accelerometer),
                  kGravity, kDt);
      truth.propagate(gyro, accelerometer, kGravity, kDt);
      Error wander = Error::Zero();
      wander.segment<3>(Filter::kGyroBias) = draw.vector(1e-3 * std::sqrt(kDt));
      wander.segment<3>(Filter::kAccelerometerBias) = draw.vector(1e-2 * std::sqrt(kDt));
      wander.segment<3>(Filter::kFeet) = draw.vector(2e-3 * std::sqrt(kDt));
      wander.segment<3>(Filter::kFeet + 3) = draw.vector(2e-3 * std::sqrt(kDt));
      truth.add_error(wander);
      for (int foot = 0; foot < 2; ++foot) {
        const Vector3d h = truth.R().transpose() * (truth.foot(foot) - truth.p());
        f.correct_by_foot(foot, h + draw.vector(1e-3), 1e-3, 0.0);
      }
    }
    const Error error = error_of(f, truth);
    sum += dot(dense(error), solve(dense(f.covariance()), dense(error)));
  }
  EXPECT_NEAR(sum / kRuns, 21.0, 4.0 * std::sqrt(42.0 / kRuns));
}

}  // namespace
}  // namespace footfall::tests
