// Forces by statics: what they balance, and that they lean least. Hume on ground of several slopes.
#include "tasks/statics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/hume.h"
#include "tests/support/hume_control.h"
#include "tests/support/matrix.h"

namespace footfall::tests {
namespace {

constexpr double kSlope = 30.0 * std::numbers::pi / 180.0;

// A large box whose top goes through `place`, turned about x by `roll`.
model::TerrainPiece ramp(const std::array<double, 3>& place, double roll) {
  const double c = std::cos(roll), s = std::sin(roll);
  model::TerrainPiece piece;
  piece.R_WP = {1, 0, 0, 0, c, -s, 0, s, c};
  piece.half = {0.1, 0.1, 0.1};
  piece.centre = {place[0], place[1] + 0.1 * s, place[2] - 0.1 * c};
  return piece;
}

class Statics : public testing::Test {
 protected:
  // The right foot's ground rises to the right by `right`, the left one's to the left by `left`.
  void stand(double right, double left) {
    const model::RobotDescription robot = load_hume();
    const model::State state = standing_state(robot);
    model::ControlModel level(robot);
    level.update(state);
    model::ModelDeviation believed;
    believed.terrain.boxes = {ramp(level.point_position(kRightFoot), -right),
                              ramp(level.point_position(kLeftFoot), left)};
    if (right == 0.0 && left == 0.0) believed.terrain.boxes.clear();
    model_ = std::make_unique<model::ControlModel>(robot, believed);
    model_->update(state);
    const std::array<int, 2> contacts = {kRightFoot, kLeftFoot};
    std::array<double, 6> f{};
    tasks::static_forces(*model_, contacts.data(), 2, f.data());
    for (int i = 0; i < 2; ++i) force_[i] = Matrix::vector(f.data() + 3 * i, 3);
  }
  Matrix place(int c) const { return Matrix::vector(model_->point_position(c)); }
  Matrix normal(int c) const { return Matrix::vector(model_->contact_normal(c)); }
  double lean(int c, const Matrix& f) const {
    const double push = dot(normal(c), f);
    return (f - push * normal(c)).norm();
  }
  double weight() const { return model_->mass() * model_->gravity(); }

  std::unique_ptr<model::ControlModel> model_;
  std::array<Matrix, 2> force_{Matrix(3), Matrix(3)};
};

TEST_F(Statics, OnLevelGroundEveryForceIsUpright) {
  stand(0.0, 0.0);
  for (int c = 0; c < 2; ++c) {
    EXPECT_NEAR(force_[c](0), 0.0, 1e-3);
    EXPECT_NEAR(force_[c](1), 0.0, 1e-3);
    EXPECT_NEAR(force_[c](2), 0.5 * weight(), 2e-3 * weight());
  }
}

// The feet's grounds face each other like the sides of a valley: pushing apart with
// tan(slope) times half the weight, both forces are along their normals.
TEST_F(Statics, InAValleyTheForcesAreAlongTheNormals) {
  stand(kSlope, kSlope);
  const double outward = 0.5 * weight() * std::tan(kSlope);
  EXPECT_NEAR(force_[0](1), outward, 5e-3 * weight());  // the right foot is at -y, pushed back
  EXPECT_NEAR(force_[1](1), -outward, 5e-3 * weight());
  for (int c = 0; c < 2; ++c) EXPECT_LE(lean(c, force_[c]), 5e-3 * weight());
}

TEST_F(Statics, TheForcesBalanceTheWeightOnUnlikeSlopes) {
  stand(kSlope, 0.3 * kSlope);
  Matrix sum = force_[0] + force_[1];
  sum(2) -= weight();
  EXPECT_LE(sum.norm(), 1e-5 * weight());
  const Matrix com = Matrix::vector(model_->com().position);
  Matrix moment = cross(place(0) - com, force_[0]) + cross(place(1) - com, force_[1]);
  const Matrix line = place(0) - place(1);
  moment -= (dot(line, moment) / dot(line, line)) * line;  // two points give none about their line
  EXPECT_LE(moment.norm(), 1e-5 * weight());
}

// A tension more or less leaves the balance and leans more, each force weighed by the normal one of
// the result. Three iterations leave 1 % of the weight.
TEST_F(Statics, NoOtherTensionLeansLess) {
  stand(kSlope, 0.3 * kSlope);
  const Matrix line = place(0) - place(1);
  const Matrix x = (1.0 / line.norm()) * line;
  const auto leans = [&](double tension) {
    double sum = 0.0;
    for (int c = 0; c < 2; ++c) {
      const double sign = c == 0 ? 1.0 : -1.0;
      sum += std::pow(lean(c, force_[c] + sign * tension * x) / dot(normal(c), force_[c]), 2);
    }
    return sum;
  };
  const double least = leans(0.0);
  EXPECT_GT(least, 1e-3);  // the slopes differ: both cannot be along their normals
  EXPECT_LT(least, leans(2.0));
  EXPECT_LT(least, leans(-2.0));
}

}  // namespace
}  // namespace footfall::tests
