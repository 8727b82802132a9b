// [Kim16] Appendix C, eq. (53) to (57): the closed form against the stacked least squares.
#include "engine/estimators/parts/marker_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

#include "core/random.h"
#include "engine/estimators/parts/marker_gate.h"
#include "tests/support/hume.h"
#include "tests/support/matrix.h"

namespace footfall::tests {
namespace {

using engine::MarkerPair;
using engine::Matrix3d;
using engine::Vector3d;

std::vector<Vector3d> hume_markers() {
  const model::ControlModel model(load_hume());
  std::vector<Vector3d> places;
  for (const model::Marker& m : model.mounts().markers) places.emplace_back(m.p_BM.data());
  return places;
}

std::vector<MarkerPair> seen_from(const std::vector<Vector3d>& places, const Matrix3d& R,
                                  const Vector3d& p, double noise, std::mt19937_64& engine) {
  core::Normal normal;
  std::vector<MarkerPair> pairs;
  for (const Vector3d& z : places) {
    const Vector3d e(normal(engine), normal(engine), normal(engine));
    pairs.push_back({z, p + R * z + noise * e});
  }
  return pairs;
}

struct StackedFit {
  Matrix3d A;
  Vector3d t;
};

// The unknown is (t, vec A) with A's ROWS stacked (E15): A z = (I kron zᵀ) vec A. Its nine rotation
// entries alone are regularised (E16); t has no row below the markers' (E18: sum over i).
StackedFit stacked_fit(const std::vector<MarkerPair>& pairs, const Matrix3d& predicted,
                       double lambda) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(3 * n + 9, 12);
  Eigen::VectorXd y(3 * n + 9);
  for (Eigen::Index i = 0; i < n; ++i) {
    const MarkerPair& pair = pairs[static_cast<std::size_t>(i)];
    for (Eigen::Index row = 0; row < 3; ++row) {
      M(3 * i + row, row) = 1.0;
      M.block(3 * i + row, 3 + 3 * row, 1, 3) = pair.place.transpose();
      y[3 * i + row] = pair.position[row];
    }
  }
  for (Eigen::Index k = 0; k < 9; ++k) {
    M(3 * n + k, 3 + k) = lambda;
    y[3 * n + k] = lambda * predicted(k / 3, k % 3);
  }
  const Matrix x = least_squares(dense(M), dense(y));
  StackedFit fit;
  fit.t = Vector3d(x.data());
  for (Eigen::Index k = 0; k < 9; ++k) fit.A(k / 3, k % 3) = x(static_cast<int>(3 + k));
  return fit;
}

TEST(MarkerFit, TheClosedFormIsTheStackedLeastSquares) {
  std::mt19937_64 engine(1);
  const Matrix3d R = engine::rotation_exp(Vector3d(0.2, -0.1, 0.7));
  const Matrix3d predicted = R * engine::rotation_exp(Vector3d(0.02, 0.01, -0.03));
  const std::vector<Vector3d> all = hume_markers();
  ASSERT_EQ(all.size(), 7U);
  for (const std::size_t count : {1U, 2U, 3U, 5U, 7U}) {
    const std::vector<Vector3d> places(all.begin(), all.begin() + static_cast<long>(count));
    const auto pairs = seen_from(places, R, {0.3, -0.2, 0.8}, 5e-3, engine);
    for (const double lambda : {0.05, 1.0, 3.0}) {
      const auto fit = engine::fit_affine(pairs, predicted, lambda);
      const StackedFit expected = stacked_fit(pairs, predicted, lambda);
      EXPECT_LT((fit.A - expected.A).norm(), 1e-10) << count << " " << lambda;
      EXPECT_LT((fit.origin(fit.A) - expected.t).norm(), 1e-10);
    }
  }
}

TEST(MarkerFit, OneMarkerLeavesThePredictedOrientation) {
  std::mt19937_64 engine(2);
  const Matrix3d predicted = engine::rotation_exp(Vector3d(0.1, 0.2, 0.3));
  const auto pairs =
      seen_from({hume_markers()[3]}, Matrix3d::Identity(), Vector3d::Zero(), 0.0, engine);
  const auto fit = engine::fit_affine(pairs, predicted, 1.0);
  EXPECT_LT((fit.A - predicted).norm(), 1e-14);
  EXPECT_LT((fit.origin(predicted) + predicted * pairs[0].place - pairs[0].position).norm(), 1e-14);
}

// For exact markers A - A_predicted = (R - A_predicted) Z Zᵀ (Z Zᵀ + lambda² I)⁻¹.
TEST(MarkerFit, TheGainIsZZtOverZZtPlusLambdaSquared) {
  std::mt19937_64 engine(3);
  const std::vector<Vector3d> places = hume_markers();
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& z : places) mean += z / static_cast<double>(places.size());
  Matrix3d ZZ = Matrix3d::Zero();
  for (const Vector3d& z : places) ZZ += (z - mean) * (z - mean).transpose();
  const Matrix3d R = engine::rotation_exp(Vector3d(0.1, 0.0, -0.2));
  const Matrix3d predicted = R * engine::rotation_exp(Vector3d(0.01, -0.02, 0.005));
  const auto pairs = seen_from(places, R, Vector3d::Zero(), 0.0, engine);
  const double lambda = 2.0;
  const Matrix3d gain = ZZ * (ZZ + lambda * lambda * Matrix3d::Identity()).inverse();
  const Matrix3d A = engine::fit_affine(pairs, predicted, lambda).A;
  EXPECT_LT((A - predicted - (R - predicted) * gain).norm(), 1e-13);
  // Hume's pattern spans 0.034, 0.078 and 0.131 m^2: 1 to 3 % of the error a frame.
  EXPECT_NEAR(gain(0, 0), 0.034 / 4.034, 1e-3);
  EXPECT_NEAR(gain(2, 2), 0.131 / 4.131, 1e-3);
}

// Deviation of the tilt by one frame alone against filtering with lambda = 1 m, markers of 1 mm:
// a first-order filter of gain g leaves sqrt(g / (2 - g)) of white noise.
TEST(MarkerFit, PredictionsTakeTheMarkersNoiseDown) {
  std::mt19937_64 engine(4);
  const std::vector<Vector3d> places = hume_markers();
  double one_shot = 0.0, filtered = 0.0;
  Matrix3d R = Matrix3d::Identity();
  constexpr int kFrames = 4000;
  for (int i = 0; i < kFrames; ++i) {
    const auto pairs = seen_from(places, Matrix3d::Identity(), Vector3d::Zero(), 1e-3, engine);
    const Matrix3d alone =
        engine::closest_rotation(engine::fit_affine(pairs, Matrix3d::Identity(), 1e-4).A);
    R = engine::closest_rotation(engine::fit_affine(pairs, R, 1.0).A);
    one_shot += engine::rotation_log(alone).squaredNorm();
    filtered += engine::rotation_log(R).squaredNorm();
  }
  one_shot = std::sqrt(one_shot / kFrames);
  filtered = std::sqrt(filtered / kFrames);
  EXPECT_GT(one_shot, 3e-3);
  EXPECT_LT(filtered, 1.2e-3);
}

TEST(MarkerFit, AFrameByItselfNeedsThreeMarkersThatAreNotOnALine) {
  std::mt19937_64 engine(5);
  const Matrix3d R = engine::rotation_exp(Vector3d(0.5, -2.0, 1.0));
  const std::vector<Vector3d> line = {{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}};
  const std::vector<Vector3d> plane = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}};
  Matrix3d found;
  EXPECT_FALSE(engine::fit_rotation(seen_from(line, R, {1, 2, 3}, 0.0, engine), found));
  EXPECT_TRUE(engine::fit_rotation(seen_from(plane, R, {1, 2, 3}, 0.0, engine), found));
  EXPECT_LT((found - R).norm(), 1e-12);
  EXPECT_FALSE(
      engine::fit_rotation(seen_from({{0, 0, 0}, {0.1, 0, 0}}, R, {1, 2, 3}, 0.0, engine), found));
}

// Each of Hume's markers in turn is 10 cm off, the others have 1 mm of noise: it alone goes, and
// the fit of the others is what it is without it.
TEST(MarkerGate, AMarkerThatDisagreesWithTheOthersIsNotUsed) {
  const auto places = hume_markers();
  const Matrix3d R = engine::rotation_exp(Vector3d(0.3, -0.2, 1.1));
  std::mt19937_64 engine(11);
  for (std::size_t odd = 0; odd < places.size(); ++odd) {
    const auto good = seen_from(places, R, Vector3d(1, 2, 1), 1e-3, engine);
    auto pairs = good;
    pairs[odd].position += Vector3d(0.06, -0.08, 0.0);
    auto rest = good;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(odd));
    Matrix3d expected, found;
    ASSERT_TRUE(engine::fit_rotation(rest, expected));
    auto tracked = pairs;
    // The prediction is off by 0.05 rad: at most 0.05 rad x 0.3 m = 15 mm.
    const Matrix3d predicted = engine::rotation_exp(Vector3d(0, 0.05, 0)) * R;
    EXPECT_EQ(engine::agreeing_markers(tracked, predicted, 0.03), 6) << odd;
    EXPECT_EQ(tracked.back().place, places[odd]);
    EXPECT_EQ(engine::agreeing_rotation(pairs, 0.03, found), 6) << odd;
    EXPECT_LT((found - expected).norm(), 1e-12);
  }
}

TEST(MarkerGate, TwoTakenForEachOtherBothGo) {
  const auto places = hume_markers();
  std::mt19937_64 engine(12);
  auto pairs = seen_from(places, Matrix3d::Identity(), Vector3d(0, 0, 1), 1e-3, engine);
  std::swap(pairs[0].position, pairs[4].position);
  Matrix3d R;
  auto tracked = pairs;
  EXPECT_EQ(engine::agreeing_markers(tracked, Matrix3d::Identity(), 0.03), 5);
  EXPECT_EQ(engine::agreeing_rotation(pairs, 0.03, R), 5);
  // Noise of 1 mm over markers 0.1 m and more from their middle.
  EXPECT_LT(engine::rotation_log(R).norm(), 0.03);
}

TEST(MarkerGate, OfThreeThatDisagreeNoneIsBelieved) {
  const auto places = hume_markers();
  std::mt19937_64 engine(13);
  auto pairs = seen_from(places, Matrix3d::Identity(), Vector3d(0, 0, 1), 0.0, engine);
  pairs.resize(3);
  Matrix3d R;
  EXPECT_EQ(engine::agreeing_rotation(pairs, 0.03, R), 3);
  pairs[1].position += 0.3 * (pairs[1].position - pairs[0].position).normalized();
  EXPECT_EQ(engine::agreeing_rotation(pairs, 0.03, R), 0);
  EXPECT_EQ(engine::agreeing_rotation(pairs, 0.0, R), 3);  // no gate
}

}  // namespace
}  // namespace footfall::tests
