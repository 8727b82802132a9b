// The WBOSC algebra against a dense solve of the equations of motion and against Appendix A.
// Equations: torques and accelerations against [Kim16] eqs. (28)-(36) and (38)-(44), evaluated
// literally.
#include "tasks/solver/wbosc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "tests/support/allocation_guard.h"
#include "tests/support/dense_solve.h"
#include "tests/support/hume_problem.h"
#include "tests/support/naive_wbosc.h"

namespace footfall::tests {
namespace {

// Condition of A and of the constrained system is up to 1e5 here: 1e-16 x 1e5 leaves 1e-11; the
// bar of the project is 1e-9 of the largest acceleration.
constexpr double kAlgebraBar = 1e-9;
constexpr int kStates = 100;

Matrix vector_of(const std::vector<double>& v, int rows) { return Matrix::vector(v.data(), rows); }

class WboscOnHume : public testing::Test {
 protected:
  // A new moving state; true: both feet.
  void next(bool dual, double tension = 0.0) {
    model_.update(random_state(robot_, random_));
    builder_.emplace(model_, solver_.problem());
    if (dual) {
      fill_dual(*builder_, model_, random_, tension);
    } else {
      fill_single(*builder_, model_, random_);
    }
  }
  DenseMotion motion(const Matrix& tau) const {
    const NaiveProblem p = dense_problem(model_, const_cast<tasks::Wbosc&>(solver_).problem());
    return dense_solve(p, tau);
  }
  Matrix tau() const { return vector_of(solver_.solution().tau, 6); }
  Matrix achieved() { return vector_of(solver_.solution().achieved, solver_.problem().task_rows); }
  Matrix commanded() { return vector_of(solver_.problem().u, solver_.problem().task_rows); }
  // J q̈ + J̇ q̇ of all task rows for joint accelerations of the dense solve.
  Matrix task_acceleration(const Matrix& qdd) {
    const tasks::WboscProblem& p = solver_.problem();
    Matrix a(p.task_rows);
    for (int i = 0; i < p.task_rows; ++i) {
      a(i) =
          p.J_bias[static_cast<std::size_t>(i)] + dot(Matrix::vector(p.J.data() + 12 * i, 12), qdd);
    }
    return a;
  }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  tasks::Wbosc solver_{hume_sizes()};
  Random random_{20160101};
  std::optional<ProblemBuilder> builder_;
};

TEST_F(WboscOnHume, WhatIsCommandedIsWhatTheEquationsOfMotionGive) {
  for (int i = 0; i < 2 * kStates; ++i) {
    const bool dual = i % 2 == 0;
    next(dual, 50.0);
    solver_.solve();
    const DenseMotion truth = motion(tau());
    const double scale = std::max(truth.qdd.max_abs(), 1.0);
    const Matrix real = task_acceleration(truth.qdd);
    const int rows = dual ? 4 : 6;  // the first level
    EXPECT_LE((real - commanded()).head(rows).max_abs(), kAlgebraBar * scale);
    EXPECT_LE((real - achieved()).max_abs(), kAlgebraBar * scale);
    EXPECT_EQ(solver_.solution().level_rank[0], rows);
  }
}

TEST_F(WboscOnHume, PredictedContactForcesAreThoseOfTheEquationsOfMotion) {
  for (int i = 0; i < kStates; ++i) {
    next(i % 2 == 0, 50.0);
    solver_.solve();
    const DenseMotion truth = motion(tau());
    const Matrix f = vector_of(solver_.solution().f, static_cast<int>(truth.f.size()));
    EXPECT_LE((f - truth.f).max_abs(), kAlgebraBar * truth.f.max_abs());
  }
}

TEST_F(WboscOnHume, TorquesAreThoseOfAppendixA) {
  for (int i = 0; i < 2 * kStates; ++i) {
    next(i % 2 == 0, 50.0);
    solver_.solve();
    const NaiveSolution naive = naive_wbosc(dense_problem(model_, solver_.problem()));
    EXPECT_LE((tau() - naive.tau).max_abs(), kAlgebraBar * naive.tau.max_abs());
  }
}

TEST_F(WboscOnHume, TwoPointFeetLeaveOneDirectionUnactuated) {
  next(true);
  solver_.solve();
  EXPECT_EQ(solver_.solution().contact_rank, 6);
  EXPECT_EQ(solver_.solution().actuation_rank, 5);
  next(false);
  solver_.solve();
  EXPECT_EQ(solver_.solution().contact_rank, 3);
  EXPECT_EQ(solver_.solution().actuation_rank, 6);
}

TEST_F(WboscOnHume, ContactsDoNotAccelerateWhateverTheTorque) {
  for (int i = 0; i < 20; ++i) {
    next(i % 2 == 0);
    const NaiveProblem p = dense_problem(model_, solver_.problem());
    solver_.solve();
    const DenseMotion truth = motion(tau());
    EXPECT_LE((p.Js * truth.qdd + p.Js_bias).max_abs(), kAlgebraBar * truth.qdd.max_abs());
  }
}

TEST_F(WboscOnHume, InternalForcesDoNotMoveTheRobot) {
  for (int i = 0; i < kStates; ++i) {
    next(true, 0.0);
    solver_.solve();
    const Matrix before = tau();
    const DenseMotion without = motion(before);
    solver_.problem().F_int[0] = 100.0;
    solver_.solve();
    const DenseMotion with = motion(tau());
    EXPECT_GT((tau() - before).max_abs(), 1.0);
    EXPECT_LE((with.qdd - without.qdd).max_abs(), kAlgebraBar * without.qdd.max_abs());
  }
}

TEST_F(WboscOnHume, LowerPrioritiesChangeNothingAbove) {
  for (int i = 0; i < kStates; ++i) {
    next(true, 50.0);
    solver_.solve();
    const DenseMotion before = motion(tau());
    const Matrix task = task_acceleration(before.qdd).head(4);
    for (int row = 4; row < 10; ++row) solver_.problem().u[static_cast<std::size_t>(row)] += 100.0;
    solver_.solve();
    const DenseMotion after = motion(tau());
    const double scale = after.qdd.max_abs();
    EXPECT_LE((task_acceleration(after.qdd).head(4) - task).max_abs(), kAlgebraBar * scale);
    EXPECT_GT((after.qdd - before.qdd).max_abs(), 1.0);
  }
}

TEST_F(WboscOnHume, AKnownExternalForceIsTakenIntoAccount) {
  next(false);
  for (double& f : solver_.problem().external) f = random_.within(20.0);
  solver_.solve();
  const DenseMotion truth = motion(tau());
  const double scale = truth.qdd.max_abs();
  EXPECT_LE((task_acceleration(truth.qdd) - commanded()).max_abs(), kAlgebraBar * scale);
}

TEST_F(WboscOnHume, ATorqueLimitClampsAndTheAchievedAccelerationSaysSo) {
  next(false);
  solver_.solve();
  ASSERT_FALSE(solver_.solution().limited);
  const std::array<double, 6> limits = {2.0, 2.0, 2.0, 2.0, 2.0, 2.0};
  ASSERT_GT(tau().max_abs(), 2.0);
  solver_.problem().torque_limit = limits.data();
  solver_.solve();
  EXPECT_TRUE(solver_.solution().limited);
  EXPECT_LE(tau().max_abs(), 2.0);
  const DenseMotion truth = motion(tau());
  const double scale = truth.qdd.max_abs();
  EXPECT_LE((achieved() - task_acceleration(truth.qdd)).max_abs(), kAlgebraBar * scale);
  EXPECT_GT((achieved() - commanded()).max_abs(), 0.1);
}

TEST_F(WboscOnHume, ANumberThatIsNotOneIsReportedAndGoneWithTheNextSolve) {
  next(false);
  solver_.problem().u[2] = std::numeric_limits<double>::quiet_NaN();
  solver_.solve();
  EXPECT_FALSE(solver_.solution().finite);
  EXPECT_EQ(tau().max_abs(), 0.0);
  EXPECT_TRUE(std::isfinite(achieved().max_abs()));
  solver_.problem().u[2] = 0.0;
  solver_.solve();
  EXPECT_TRUE(solver_.solution().finite);
  EXPECT_TRUE(std::isfinite(tau().max_abs()));
  EXPECT_TRUE(std::isfinite(achieved().max_abs()));
}

TEST_F(WboscOnHume, SolvingAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  for (int i = 0; i < 4; ++i) {
    next(i % 2 == 0, 50.0);
    const AllocationGuard guard;
    solver_.solve();
    EXPECT_EQ(guard.allocations(), 0);
  }
}

}  // namespace
}  // namespace footfall::tests
