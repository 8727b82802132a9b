// Internal forces: conventions, size and feedback.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tasks/solver/wbosc.h"
#include "tests/support/dense_solve.h"
#include "tests/support/hume_problem.h"
#include "tests/support/naive_wbosc.h"

namespace footfall::tests {
namespace {

class WboscTension : public testing::Test {
 protected:
  void fill(const model::State& state, double tension) {
    model_.update(state);
    builder_.emplace(model_, solver_.problem());
    fill_dual(*builder_, model_, random_, tension);
  }
  Matrix force_of(const Matrix& tau) {
    const NaiveProblem p = dense_problem(model_, solver_.problem());
    return dense_solve(p, tau).f;
  }
  Matrix tau() const { return Matrix::vector(solver_.solution().tau.data(), 6); }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  tasks::Wbosc solver_{hume_sizes()};
  Random random_{3};
  std::optional<ProblemBuilder> builder_;
};

TEST_F(WboscTension, AHundredNewtonsAreAHundredAtEachFootPushingApart) {
  fill(standing_state(robot_), 100.0);
  // Symmetric and at rest; nothing asked for: no sideways acceleration, both feet carry the same.
  for (double& u : solver_.problem().u) u = 0.0;
  solver_.solve();
  const Matrix f = force_of(tau());
  // The right foot stands at -y. The robot pushes it outwards (-y), so the ground pushes it back.
  EXPECT_NEAR(f(1), 100.0, 0.02);
  EXPECT_NEAR(f(4), -100.0, 0.02);
  EXPECT_NEAR(f(2), 0.5 * model_.mass() * 9.81, 1.0);  // standing: the ground pushes up, F_r = -f
  EXPECT_NEAR(f(5), 0.5 * model_.mass() * 9.81, 1.0);
}

TEST_F(WboscTension, TheMeanOfBothFeetIsWhatWasAskedForInAnyState) {
  for (int i = 0; i < 50; ++i) {
    const double wanted = random_.within(150.0);
    fill(random_state(robot_, random_), wanted);
    solver_.solve();
    const Matrix f = force_of(tau());
    double apart = 0.0;
    for (int c = 0; c < 6; ++c)
      apart += solver_.problem().W_int[static_cast<std::size_t>(c)] * f(c);
    const double tolerance = 1e-9 * f.max_abs();
    EXPECT_NEAR(apart, wanted, tolerance);
    EXPECT_NEAR(solver_.solution().internal[0], apart, tolerance);
  }
}

// Any state, moving, its feet anywhere: the accelerations of all coordinates are the same to 1e-9
// of their size with 100 N and without.
TEST_F(WboscTension, ATensionMovesNothingInAnyState) {
  for (int i = 0; i < 50; ++i) {
    fill(random_state(robot_, random_), 0.0);
    solver_.solve();
    const Matrix without = dense_solve(dense_problem(model_, solver_.problem()), tau()).qdd;
    const Matrix before = tau();
    solver_.problem().F_int[0] = 100.0;
    solver_.solve();
    const Matrix with = dense_solve(dense_problem(model_, solver_.problem()), tau()).qdd;
    EXPECT_GT((tau() - before).max_abs(), 0.1);
    EXPECT_LE((with - without).max_abs(), 1e-9 * without.max_abs());
  }
}

TEST_F(WboscTension, MeasuredTensionIsThatOfTheMeasuredTorque) {
  fill(random_state(robot_, random_), 40.0);
  const std::array<double, 6> measured = {3.0, -20.0, 40.0, -4.0, -15.0, 30.0};
  solver_.problem().tau_measured = measured.data();
  solver_.solve();
  const Matrix f = force_of(Matrix::vector(measured.data(), 6));
  double apart = 0.0;
  for (int c = 0; c < 6; ++c) apart += solver_.problem().W_int[static_cast<std::size_t>(c)] * f(c);
  EXPECT_NEAR(solver_.solution().internal_measured[0], apart, 1e-9 * f.max_abs());
}

// F_cmd = F_ref + K_F (F_ref - F) with an actuator error that alone makes F wrong by d: the
// measured torque is the last command, whatever the gain, so the error goes (-K_F)^n towards
// d/(1+K_F), or away from it beyond a gain of 1. tests/unit/sim/contact_force_test.cc has it in the
// simulator.
TEST_F(WboscTension, FeedbackTendsToOneOverOnePlusItsGainOfTheErrorOrAlternatesAway) {
  const std::array<double, 6> actuator_error = {1.0, -2.0, 3.0, -1.0, 2.0, 4.0};
  fill(random_state(robot_, random_), 60.0);
  double d = 0.0;  // without feedback
  for (const double gain : {0.0, 0.3, 0.7, 1.2}) {
    std::array<double, 6> measured{};
    solver_.problem().tau_measured = measured.data();
    solver_.problem().K_F[0] = gain;
    double at_first = 0.0;
    for (int n = 0; n < 12; ++n) {
      solver_.solve();
      for (std::size_t j = 0; j < 6; ++j) {
        measured[j] = solver_.solution().tau[j] + actuator_error[j];
      }
      solver_.solve();
      const double error = 60.0 - solver_.solution().internal_measured[0];
      if (gain == 0.0) d = error;
      const double rest = error - d / (1.0 + gain);
      if (n == 0) at_first = rest;
      EXPECT_NEAR(rest, at_first * std::pow(-gain, n), 1e-7 * std::max(1.0, std::pow(gain, n)));
    }
  }
  EXPECT_GT(std::abs(d), 1.0);
}

TEST_F(WboscTension, TheCorrectedAppendixGivesTheSameTorqueWithFeedback) {
  for (int i = 0; i < 50; ++i) {
    fill(random_state(robot_, random_), 60.0);
    std::array<double, 6> measured{};
    for (double& t : measured) t = random_.within(40.0);
    solver_.problem().tau_measured = measured.data();
    solver_.problem().K_F[0] = 2.0;
    solver_.solve();
    const Matrix expected = naive_wbosc(dense_problem(model_, solver_.problem())).tau;
    EXPECT_LE((tau() - expected).max_abs(), 1e-9 * expected.max_abs());
  }
}

TEST_F(WboscTension, OnOneFootThereIsNoTensionToControl) {
  model_.update(random_state(robot_, random_));
  builder_.emplace(model_, solver_.problem());
  fill_single(*builder_, model_, random_);
  solver_.solve();
  const Matrix before = tau();
  std::array<double, 3> w = {0.0, 1.0, 0.0};
  std::copy(w.begin(), w.end(), solver_.problem().W_int.begin());
  solver_.problem().F_int[0] = 100.0;
  solver_.problem().internal_rows = solver_.problem().named_internal_rows = 1;
  solver_.solve();
  EXPECT_LE((tau() - before).max_abs(), 1e-12);
}

// Three contacts: the named pair gets its force, the others come as near to theirs as they can.
TEST_F(WboscTension, NamedTensionsComeBeforeTheOthers) {
  tasks::Wbosc solver({12, 6, 9, 16, 4, 3});
  model_.update(random_state(robot_, random_));
  ProblemBuilder builder(model_, solver.problem());
  for (const int point : {kRightFoot, kLeftFoot, 4}) builder.contact(point);
  builder.tension(0, kRightFoot, 1, kLeftFoot, 80.0);
  builder.tension(0, kRightFoot, 2, 4, 0.0);
  builder.tension(1, kLeftFoot, 2, 4, 0.0);
  solver.problem().named_internal_rows = 1;
  solver.solve();
  EXPECT_NEAR(solver.solution().internal[0], 80.0, 1e-7);
  const NaiveProblem p = dense_problem(model_, solver.problem());
  const Matrix tau = Matrix::vector(solver.solution().tau.data(), 6);
  const Matrix qdd = dense_solve(p, tau).qdd;
  const Matrix still = dense_solve(p, Matrix(6)).qdd;
  EXPECT_LE((qdd - still).max_abs(), 1e-9 * still.max_abs());
}

}  // namespace
}  // namespace footfall::tests
