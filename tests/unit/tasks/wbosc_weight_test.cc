// Weights inside a level: 0 takes a row out of it, and the lightest ones get what the heavy ones
// leave. Oracles: the same problem without the rows, and with the light rows in a level of their
// own: the limit of weighted least squares.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "tasks/solver/wbosc.h"
#include "tests/support/dense_solve.h"
#include "tests/support/hume_problem.h"
#include "tests/support/matrix.h"
#include "tests/support/naive_wbosc.h"

namespace footfall::tests {
namespace {

// Two feet: the torques move five directions. CoM x and y beside height and attitude are six rows.
class WboscWeights : public testing::Test {
 protected:
  enum class Light { first, last, absent, below };

  void next() { model_.update(random_state(robot_, random_, StateSpread{})); }
  void draw() {
    for (double& u : wanted_) u = random_.within(5.0);
  }
  // Torque with CoM x and y of this weight, at one end of the level or in a level below it.
  Matrix tau(Light place, double weight = 1.0) {
    tasks::WboscProblem& p = solver_.problem();
    builder_.emplace(model_, p);
    builder_->contact(kRightFoot);
    builder_->contact(kLeftFoot);
    if (place == Light::first) add_light(weight);
    builder_->row(model_.com(), {0.0, 0.0, 1.0}, wanted_[2]);
    for (int axis = 0; axis < 3; ++axis) {
      builder_->row(model_.base_rotation(), builder_->heading(axis), wanted_[at(3 + axis)]);
    }
    if (place == Light::last) add_light(weight);
    builder_->end_level();
    if (place == Light::below) {
      add_light(1.0);
      builder_->end_level();
    }
    for (int j = 0; j < 6; ++j) builder_->joint_row(j, wanted_[at(6 + j)]);
    builder_->end_level();
    solver_.solve();
    EXPECT_TRUE(solver_.solution().finite);
    return Matrix::vector(solver_.solution().asked.data(), 6);
  }
  void add_light(double weight) {
    tasks::WboscProblem& p = solver_.problem();
    for (const bool y : {false, true}) {
      p.weight[at(p.task_rows)] = weight;
      builder_->row(model_.com(), {y ? 0.0 : 1.0, y ? 1.0 : 0.0, 0.0}, wanted_[y ? 1 : 0]);
    }
  }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  tasks::Wbosc solver_{{12, 6, 18, 64, 4, 3}};
  Random random_{7};
  std::optional<ProblemBuilder> builder_;
  std::array<double, 12> wanted_{};
};

TEST_F(WboscWeights, RowsOfWeightZeroAreNoPartOfTheirLevel) {
  for (int i = 0; i < 50; ++i) {
    next();
    draw();
    const Matrix without = tau(Light::absent);
    const int rank = solver_.solution().level_rank[0];
    for (const Light place : {Light::first, Light::last}) {
      for (const double none : {0.0, -0.0, -1.0, std::nan("")}) {
        const Matrix with = tau(place, none);
        EXPECT_EQ(solver_.solution().level_rows[0], 4);
        EXPECT_EQ(solver_.solution().level_rank[0], rank);
        EXPECT_LE((with - without).max_abs(), 1e-9 * without.max_abs());
      }
    }
  }
}

// What rows of weight 0 get is told all the same: as the equations of motion have it.
TEST_F(WboscWeights, TheAccelerationOfARowOfWeightZeroIsTrue) {
  for (const Light place : {Light::first, Light::last}) {
    next();
    draw();
    const Matrix torque = tau(place, 0.0);
    const tasks::WboscProblem& p = solver_.problem();
    const Matrix qdd = dense_solve(dense_problem(model_, p), torque).qdd;
    const Matrix real = Matrix::of_rows(p.J.data(), p.task_rows, 12) * qdd +
                        Matrix::vector(p.J_bias.data(), p.task_rows);
    const Matrix told = Matrix::vector(solver_.solution().achieved.data(), p.task_rows);
    EXPECT_LE((told - real).max_abs(), 1e-9 * qdd.max_abs());
  }
}

TEST_F(WboscWeights, ALevelWithoutWeightHasNoRankAndTakesNothing) {
  next();
  draw();
  const Matrix expected = [&] {
    builder_.emplace(model_, solver_.problem());
    builder_->contact(kRightFoot);
    for (int j = 0; j < 6; ++j) builder_->joint_row(j, wanted_[at(6 + j)]);
    builder_->end_level();
    solver_.solve();
    return Matrix::vector(solver_.solution().asked.data(), 6);
  }();
  builder_.emplace(model_, solver_.problem());
  builder_->contact(kRightFoot);
  add_light(0.0);
  builder_->end_level();
  for (int j = 0; j < 6; ++j) builder_->joint_row(j, wanted_[at(6 + j)]);
  builder_->end_level();
  solver_.solve();
  EXPECT_EQ(solver_.solution().level_rows[0], 0);
  EXPECT_EQ(solver_.solution().level_rank[0], 0);
  EXPECT_EQ(solver_.solution().level_condition[0], 1.0);
  EXPECT_LE((Matrix::vector(solver_.solution().asked.data(), 6) - expected).max_abs(), 1e-12);
}

// Rows of joints are long ones: with the weight 1 they would count for the level above, too.
TEST_F(WboscWeights, TheConditionOfALevelKnowsNoRowsOfWeightZero) {
  next();
  const auto condition = [&](std::optional<double> weight_of_joints) {
    tasks::WboscProblem& p = solver_.problem();
    builder_.emplace(model_, p);
    builder_->contact(kRightFoot);
    builder_->contact(kLeftFoot);
    builder_->row(model_.com(), {0.0, 0.0, 1.0}, 0.0);
    builder_->end_level();
    for (int j = 0; weight_of_joints && j < 6; ++j) {
      p.weight[at(p.task_rows)] = *weight_of_joints;
      builder_->joint_row(j, 0.0);
    }
    builder_->end_level();
    solver_.solve();
    return solver_.solution().level_condition[0];
  };
  const double alone = condition({});
  EXPECT_NEAR(condition(0.0), alone, 1e-9 * alone);
  EXPECT_GT(condition(1.0), 1.5 * alone);
}

// The distance to the limit falls with the weight, until the digits end: never a jump.
TEST_F(WboscWeights, LightRowsApproachALevelBelow) {
  for (int i = 0; i < 50; ++i) {
    next();
    draw();
    const Matrix limit = tau(Light::below);
    const double size = limit.max_abs();
    for (const Light place : {Light::first, Light::last}) {
      double before = INFINITY;
      for (const double w : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
        const double distance = (tau(place, w) - limit).max_abs() / size;
        EXPECT_EQ(solver_.solution().level_rank[0], 5);
        EXPECT_LE(distance, std::max(1.01 * before, 1e-7)) << w;
        before = distance;
      }
      EXPECT_LE(before, 1e-6);
      for (const double w : {1e-20, 1e-30, 1e-100, 1e-300, 5e-324}) {
        EXPECT_LE((tau(place, w) - limit).max_abs() / size, 1e-6) << w;
      }
    }
  }
}

TEST_F(WboscWeights, OnlyTheRatioOfWeightsCounts) {
  next();
  draw();
  builder_.reset();
  const Matrix one = tau(Light::first, 1.0);
  tasks::WboscProblem& p = solver_.problem();
  for (const double scale : {1e-300, 1e-9, 1e9, 1e300}) {
    for (int r = 0; r < 6; ++r) p.weight[at(r)] = scale;
    solver_.solve();
    EXPECT_LE((Matrix::vector(solver_.solution().asked.data(), 6) - one).max_abs(),
              1e-9 * one.max_abs());
  }
}

}  // namespace
}  // namespace footfall::tests
