// Where rank drops: more task rows than freedom, levels without freedom, redundant contacts, none.
#include <gtest/gtest.h>

#include <array>
#include <optional>

#include "tasks/solver/wbosc.h"
#include "tests/support/dense_solve.h"
#include "tests/support/hume_problem.h"
#include "tests/support/naive_wbosc.h"

namespace footfall::tests {
namespace {

constexpr double kRankBar = 1e-9;  // of the largest acceleration or torque

// A point fixed to a link, from what the model gives of others on the same link.
model::Kinematics3 between(const model::Kinematics3& a, const model::Kinematics3& b, double share) {
  model::Kinematics3 k = a;
  for (std::size_t i = 0; i < 3; ++i) {
    k.position[i] += share * (b.position[i] - a.position[i]);
    k.bias[i] += share * (b.bias[i] - a.bias[i]);
  }
  for (std::size_t i = 0; i < k.jacobian.size(); ++i) {
    k.jacobian[i] += share * (b.jacobian[i] - a.jacobian[i]);
  }
  return k;
}

// p = o + r: J = J_o - [r]x J_ω, bias = bias_o + bias_ω x r + ω x (ω x r).
model::Kinematics3 on_torso(const model::ControlModel& m, const std::array<double, 3>& r) {
  model::Kinematics3 k = m.point(2);  // hip_center, the torso's origin
  const model::Kinematics3& w = m.base_rotation();
  const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                 a[0] * b[1] - a[1] * b[0]};
  };
  const auto n = static_cast<std::size_t>(m.nv());
  for (std::size_t q = 0; q < n; ++q) {
    const auto v = cross({w.jacobian[q], w.jacobian[n + q], w.jacobian[2 * n + q]}, r);
    for (std::size_t i = 0; i < 3; ++i) k.jacobian[i * n + q] += v[i];
  }
  const auto wxr = cross(w.velocity, r);
  const auto a = cross(w.bias, r), c = cross(w.velocity, wxr);
  for (std::size_t i = 0; i < 3; ++i) {
    k.position[i] += r[i];
    k.bias[i] += a[i] + c[i];
  }
  return k;
}

class WboscRank : public testing::Test {
 protected:
  // `moving`: a link that turns cannot keep several of its points unaccelerated.
  void next(bool moving = true) {
    const StateSpread at_rest = {0.15, 0.1, 3.1, 0.5, 0.0, 0.0};
    model_.update(random_state(robot_, random_, moving ? StateSpread{} : at_rest));
    builder_.emplace(model_, solver_.problem());
  }
  void add_point_rows(const model::Kinematics3& k, double limit) {
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<double, 3> axis{};
      axis[i] = 1.0;
      builder_->row(k, axis, random_.within(limit));
    }
  }
  // 20 markers: 8 on the torso, 6 on each shank; one level of 60 rows.
  void add_markers() {
    for (int i = 0; i < 8; ++i) {
      add_point_rows(
          on_torso(model_, {random_.within(0.1), random_.within(0.1), random_.within(0.3)}), 5.0);
    }
    for (int i = 0; i < 6; ++i) {
      add_point_rows(between(model_.point(0), model_.point(5), 0.15 * i), 5.0);
      add_point_rows(between(model_.point(1), model_.point(6), 0.15 * i), 5.0);
    }
    builder_->end_level();
  }
  void add_contact(const model::Kinematics3& k) {
    tasks::WboscProblem& p = solver_.problem();
    std::copy(k.jacobian.begin(), k.jacobian.end(), p.Js.begin() + 12 * p.contact_rows);
    std::copy(k.bias.begin(), k.bias.end(), p.Js_bias.begin() + p.contact_rows);
    p.contact_rows += 3;
  }
  NaiveProblem dense() { return dense_problem(model_, solver_.problem()); }
  Matrix tau() const { return Matrix::vector(solver_.solution().tau.data(), 6); }
  Matrix achieved() {
    return Matrix::vector(solver_.solution().achieved.data(), solver_.problem().task_rows);
  }
  Matrix commanded() {
    return Matrix::vector(solver_.problem().u.data(), solver_.problem().task_rows);
  }
  // The achieved accelerations as said and as the equations of motion give them.
  void expect_truthful() {
    const NaiveProblem p = dense();
    const DenseMotion truth = dense_solve(p, tau());
    const Matrix qdd = truth.qdd;
    int row = 0;
    for (const NaiveLevel& level : p.levels) {
      const auto rows = static_cast<int>(level.J.rows());
      const Matrix real = level.J * qdd + level.J_bias;
      EXPECT_LE((real - achieved().middle_rows(row, rows)).max_abs(),
                kRankBar * std::max(1.0, qdd.max_abs()));
      row += rows;
    }
  }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  tasks::Wbosc solver_{{12, 6, 18, 64, 4, 3}};
  Random random_{99};
  std::optional<ProblemBuilder> builder_;
};

TEST_F(WboscRank, TwentyMarkersInOneLevelGiveTheLeastSquaresAcceleration) {
  for (int i = 0; i < 20; ++i) {
    next();
    const bool dual = i % 2 == 0;
    builder_->contact(kRightFoot);
    if (dual) builder_->contact(kLeftFoot);
    add_markers();
    solver_.solve();
    EXPECT_EQ(solver_.solution().level_rank[0], dual ? 5 : 6);
    EXPECT_TRUE(solver_.solution().finite);
    const NaiveProblem p = dense();
    const Matrix expected = naive_wbosc(p).tau;
    EXPECT_LE((tau() - expected).max_abs(), kRankBar * expected.max_abs());
    // Least squares: no torque can reduce the residual further.
    const Matrix zero = dense_solve(p, Matrix(6)).qdd;
    for (int j = 0; j < 6; ++j) {
      const Matrix unit = Matrix::unit(6, j);
      const Matrix change = p.levels[0].J * (dense_solve(p, unit).qdd - zero);
      EXPECT_NEAR(dot(change, achieved() - commanded()), 0.0,
                  kRankBar * change.norm() * commanded().norm());
    }
    expect_truthful();
  }
}

TEST_F(WboscRank, WeightsShareTheResidualOfAnOverDeterminedLevel) {
  next();
  builder_->contact(kRightFoot);
  add_markers();
  solver_.solve();
  const double before = (achieved() - commanded()).head(3).norm();
  for (std::size_t i = 0; i < 3; ++i) solver_.problem().weight[i] = 1e4;
  solver_.solve();
  EXPECT_LT((achieved() - commanded()).head(3).norm(), 0.1 * before);
  const Matrix expected = naive_wbosc(dense()).tau;
  EXPECT_LE((tau() - expected).max_abs(), 1e-7 * expected.max_abs());
}

TEST_F(WboscRank, ALevelInTheSpanOfAHigherOneGetsNoRankAndAddsNoTorque) {
  for (int i = 0; i < 20; ++i) {
    next();
    fill_single(*builder_, model_, random_);  // uses all six actuated directions
    solver_.solve();
    const Matrix before = tau();
    for (int j = 0; j < 6; ++j) builder_->joint_row(j, random_.within(1e3));
    builder_->end_level();
    builder_->row(model_.com(), {0.0, 0.0, 1.0}, 1e3);
    builder_->end_level();
    solver_.solve();
    EXPECT_EQ(solver_.solution().level_rank[0], 6);
    EXPECT_EQ(solver_.solution().level_rank[1], 0);
    EXPECT_EQ(solver_.solution().level_rank[2], 0);
    EXPECT_LE((tau() - before).max_abs(), kRankBar * before.max_abs());
  }
}

TEST_F(WboscRank, ATaskThatRepeatsPartOfAHigherOneGetsTheRest) {
  next();
  builder_->contact(kRightFoot);
  builder_->contact(kLeftFoot);
  builder_->row(model_.com(), {0.0, 0.0, 1.0}, 1.0);
  builder_->end_level();
  builder_->row(model_.com(), {0.0, 0.0, 1.0}, 50.0);
  builder_->row(model_.base_rotation(), builder_->heading(1), 2.0);
  builder_->end_level();
  solver_.solve();
  EXPECT_EQ(solver_.solution().level_rank[1], 1);
  EXPECT_NEAR(achieved()(0), 1.0, kRankBar);
  expect_truthful();
}

TEST_F(WboscRank, RowsOfZerosHaveNoRank) {
  next();
  builder_->contact(kRightFoot);
  builder_->row(model_.com(), {0.0, 0.0, 0.0}, 5.0);
  builder_->end_level();
  solver_.solve();
  EXPECT_EQ(solver_.solution().level_rank[0], 0);
  EXPECT_EQ(tau().max_abs(), 0.0);
}

TEST_F(WboscRank, FourContactPointsOnOneLinkHoldItLikeAPlate) {
  for (int i = 0; i < 20; ++i) {
    next(false);
    for (const auto& corner : {std::array<double, 3>{0.1, 0.1, 0.0},
                               {0.1, -0.1, 0.0},
                               {-0.1, 0.1, 0.0},
                               {-0.1, -0.1, 0.02}}) {
      add_contact(on_torso(model_, corner));
    }
    for (int j = 0; j < 6; ++j) builder_->joint_row(j, random_.within(5.0));
    builder_->end_level();
    solver_.solve();
    EXPECT_EQ(solver_.solution().contact_rank, 6);
    EXPECT_EQ(solver_.solution().actuation_rank, 6);
    EXPECT_EQ(solver_.solution().level_rank[0], 6);
    expect_truthful();
    EXPECT_LE((achieved() - commanded()).max_abs(), kRankBar * 10.0);
    // Of all ground forces that give this motion, the predicted one is the smallest.
    const NaiveProblem p = dense();
    const DenseMotion truth = dense_solve(p, tau());
    const Matrix needed = p.A * truth.qdd + p.h - p.U.transpose() * tau();
    const Matrix smallest = pseudo_inverse(p.Js.transpose()) * needed;
    const Matrix f = Matrix::vector(solver_.solution().f.data(), 12);
    EXPECT_LE((f - smallest).max_abs(), 1e-7 * smallest.max_abs());
  }
}

TEST_F(WboscRank, ContactPointsOnALineLeaveTheTurnAboutIt) {
  next(false);
  for (int i = 0; i < 4; ++i) add_contact(between(model_.point(0), model_.point(5), 0.2 * i));
  builder_->row(model_.com(), {0.0, 0.0, 1.0}, 1.0);
  builder_->row(model_.base_rotation(), builder_->heading(1), 1.0);
  builder_->end_level();
  solver_.solve();
  EXPECT_EQ(solver_.solution().contact_rank, 5);
  EXPECT_TRUE(solver_.solution().finite);
  expect_truthful();
}

TEST_F(WboscRank, RedundantContactsOnAMovingLinkAreHeldAsNearlyAsPossible) {
  for (int i = 0; i < 20; ++i) {
    next();
    for (const auto& corner : {std::array<double, 3>{0.1, 0.1, 0.0},
                               {0.1, -0.1, 0.0},
                               {-0.1, 0.1, 0.0},
                               {-0.1, -0.1, 0.02}}) {
      add_contact(on_torso(model_, corner));
    }
    for (int j = 0; j < 6; ++j) builder_->joint_row(j, random_.within(5.0));
    builder_->end_level();
    solver_.solve();
    const Matrix expected = naive_wbosc(dense()).tau;
    EXPECT_LE((tau() - expected).max_abs(), kRankBar * expected.max_abs());
  }
}

TEST_F(WboscRank, ThreeContactsOnThreeLinksAreSolvedLikeTwo) {
  for (int i = 0; i < 20; ++i) {
    next();
    builder_->contact(kRightFoot);
    builder_->contact(kLeftFoot);
    builder_->contact(4);  // the torso's top
    for (int j = 0; j < 6; ++j) builder_->joint_row(j, random_.within(5.0));
    builder_->end_level();
    solver_.solve();
    EXPECT_EQ(solver_.solution().contact_rank, 9);
    EXPECT_EQ(solver_.solution().actuation_rank, 3);
    const Matrix expected = naive_wbosc(dense()).tau;
    EXPECT_LE((tau() - expected).max_abs(), kRankBar * expected.max_abs());
    expect_truthful();
  }
}

TEST_F(WboscRank, InTheAirTheJointsStillObey) {
  for (int i = 0; i < 20; ++i) {
    next();
    for (int j = 0; j < 6; ++j) builder_->joint_row(j, random_.within(5.0));
    builder_->end_level();
    solver_.solve();
    EXPECT_EQ(solver_.solution().contact_rank, 0);
    EXPECT_EQ(solver_.solution().actuation_rank, 6);
    EXPECT_LE((achieved() - commanded()).max_abs(), kRankBar * 10.0);
    expect_truthful();
  }
}

TEST_F(WboscRank, WithoutTasksThereIsNoTorque) {
  next();
  builder_->contact(kRightFoot);
  solver_.solve();
  EXPECT_EQ(tau().max_abs(), 0.0);
  expect_truthful();
}

}  // namespace
}  // namespace footfall::tests
