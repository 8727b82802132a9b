// Frames of points and angular momentum against finite differences and their own definitions; the
// walking surface against its formula.
#include <gtest/gtest.h>

#include "model/height_surface.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/hume.h"
#include "tests/support/matrix.h"

namespace footfall::tests {
namespace {

// Central differences with h = 1e-4: h²/6 times third derivatives (angular speed cubed, up to
// 40 rad³/s³) is below 1e-7; round-off 1e-16/h far below.
constexpr double kStep = 1e-4;
constexpr double kFrameDifference = 1e-6;

class FramesOfHume : public testing::Test {
 protected:
  Matrix velocity_of(const model::State& s) const {
    Matrix v(12);
    for (int k = 0; k < 12; ++k) {
      const auto q = static_cast<std::size_t>(k);
      v(k) = k < 3 ? s.v_WB[q] : k < 6 ? s.w_WB_B[q - 3] : s.qd[q - 6];
    }
    return v;
  }
  Matrix jacobian(const model::Kinematics3& k) const {
    return Matrix::of_rows(k.jacobian.data(), 3, 12);
  }
  Matrix orientation(int point) const {
    return Matrix::of_rows(model_.frame(point).R_WF.data(), 3, 3);
  }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  Random random_{77};
};

TEST_F(FramesOfHume, AFramesAngularVelocityTurnsItsRotation) {
  for (int i = 0; i < 20; ++i) {
    const model::State s = random_state(robot_, random_);
    for (const int point : {1, 5, 6}) {
      model_.update(s);
      const Matrix w = Matrix::vector(model_.frame(point).angular.velocity);
      const Matrix bias = Matrix::vector(model_.frame(point).angular.bias);
      const Matrix rate = jacobian(model_.frame(point).angular) * velocity_of(s);
      EXPECT_LE((rate - w).max_abs(), 1e-12);
      model_.update(integrated(s, kStep, 6));
      const Matrix after = orientation(point);
      const Matrix w_after = jacobian(model_.frame(point).angular) * velocity_of(s);
      model_.update(integrated(s, -kStep, 6));
      const Matrix turn = rotation_vector(after * orientation(point).transpose());
      EXPECT_LE((turn / (2 * kStep) - w).max_abs(), kFrameDifference);
      const Matrix w_before = jacobian(model_.frame(point).angular) * velocity_of(s);
      EXPECT_LE(((w_after - w_before) / (2 * kStep) - bias).max_abs(), kFrameDifference);
    }
  }
}

TEST_F(FramesOfHume, RollPitchAndYawAreThoseOfTheRotation) {
  model_.update(random_state(robot_, random_));
  const auto& rpy = model_.frame(5).rpy;
  const Matrix R = rotation(Matrix::unit(3, 2), rpy[2]) * rotation(Matrix::unit(3, 1), rpy[1]) *
                   rotation(Matrix::unit(3, 0), rpy[0]);
  EXPECT_LE((R - orientation(5)).max_abs(), 1e-14);
}

TEST_F(FramesOfHume, APointOfABodyIsTheBodysOwnFrame) {
  robot_.points.push_back({"trunk", "", robot_.floating_base});
  const model::ControlModel model(robot_);
  const int trunk = model.point_count() - 1;
  const_cast<model::ControlModel&>(model).update(random_state(robot_, random_));
  EXPECT_EQ(model.point(trunk).position, model.state().p_WB);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(model.frame(trunk).R_WF[k], model.R_WB()[k], 1e-15);
  }
}

TEST_F(FramesOfHume, AngularMomentumIsItsMatrixTimesTheVelocity) {
  for (int i = 0; i < 20; ++i) {
    const model::State s = random_state(robot_, random_);
    model_.update(s);
    const auto& h = model_.centroidal_momentum();
    const Matrix product = jacobian(model_.angular_momentum()) * velocity_of(s);
    EXPECT_LE((product - Matrix::vector({h[3], h[4], h[5]})).max_abs(), 1e-12);
  }
}

TEST_F(FramesOfHume, TheMomentumsBiasIsTheDerivativeOfItsMatrix) {
  for (int i = 0; i < 20; ++i) {
    const model::State s = random_state(robot_, random_);
    model_.update(integrated(s, kStep, 6));
    const Matrix after = jacobian(model_.angular_momentum()) * velocity_of(s);
    model_.update(integrated(s, -kStep, 6));
    const Matrix before = jacobian(model_.angular_momentum()) * velocity_of(s);
    model_.update(s);
    const Matrix bias = Matrix::vector(model_.angular_momentum().bias);
    EXPECT_LE(((after - before) / (2 * kStep) - bias).max_abs(), kFrameDifference);
  }
}

// In free fall nothing turns the robot about its CoM: A_G q̈ + Ȧ_G q̇ = 0 under A q̈ + b + g = 0.
TEST_F(FramesOfHume, FreeFallKeepsTheAngularMomentumWhateverTheJointsDo) {
  for (int i = 0; i < 20; ++i) {
    model_.update(random_state(robot_, random_));
    Matrix A(12, 12);
    model_.mass_matrix(A.data());
    Matrix force = -Matrix::vector(model_.bias().data(), 12);
    for (int j = 6; j < 12; ++j) force(j) += random_.within(50.0);  // joint torques
    const Matrix a = solve(A, force);
    const Matrix rate =
        jacobian(model_.angular_momentum()) * a + Matrix::vector(model_.angular_momentum().bias);
    EXPECT_LE(rate.max_abs(), 1e-9);
  }
}

TEST_F(FramesOfHume, AskingForFramesAndMomentumAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  const model::State s = random_state(robot_, random_);
  const AllocationGuard guard;
  model_.update(s);
  double sum = model_.frame(1).rpy[0] + model_.angular_momentum().bias[2];
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_TRUE(std::isfinite(sum));
}

// One ramp of 7 cm over 0.4 m: half its height in its middle, where the slope is 15/8 of the mean.
TEST(HeightSurface, RisesSmoothlyAndStaysAtItsEnds) {
  const model::HeightSurface surface = {{{0.1, 0.5, 0.07}}};
  EXPECT_EQ(surface.at(0.1).height, 0.0);
  EXPECT_EQ(surface.at(-3.0).slope, 0.0);
  EXPECT_DOUBLE_EQ(surface.at(0.3).height, 0.035);
  EXPECT_NEAR(surface.at(0.3).slope, 15.0 / 8.0 * 0.07 / 0.4, 1e-15);
  EXPECT_NEAR(surface.at(0.3).curvature, 0.0, 1e-12);
  EXPECT_EQ(surface.at(0.5).height, 0.07);
  EXPECT_EQ(surface.at(9.0).height, 0.07);
  EXPECT_EQ(surface.at(9.0).curvature, 0.0);
}

TEST(HeightSurface, UpAndDownAgainEndsWhereItBegan) {
  const model::HeightSurface surface = {{{0.1, 0.5, 0.07}, {1.1, 1.5, -0.07}}};
  EXPECT_EQ(surface.at(0.8).height, 0.07);
  EXPECT_EQ(surface.at(2.0).height, 0.0);
}

TEST(HeightSurface, SlopeAndCurvatureAreDerivativesWithoutAJump) {
  const model::HeightSurface surface = {{{0.1, 0.5, 0.07}, {0.4, 0.7, -0.02}}};
  constexpr double h = 1e-6;
  // The largest third derivative is 60 rise/length³ = 66 /m²: within h of a ramp's end the
  // differences miss up to 66 h.
  for (double x = 0.0; x < 0.8; x += 0.0125) {
    const auto before = surface.at(x - h), after = surface.at(x + h);
    EXPECT_NEAR(surface.at(x).slope, (after.height - before.height) / (2 * h), 1e-8);
    EXPECT_NEAR(surface.at(x).curvature, (after.slope - before.slope) / (2 * h), 66 * h);
  }
}

}  // namespace
}  // namespace footfall::tests
