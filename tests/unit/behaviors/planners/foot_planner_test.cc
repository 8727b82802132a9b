// Foot placement against the pendulum integrated numerically, and the step-to-step map it makes.
// Equations: [Kim16] eqs. (19), (21) with E1, E2.
#include "behaviors/planners/foot_planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

namespace footfall::tests {
namespace {

using behaviors::FootPlan;
using behaviors::FootPlannerInput;
using behaviors::FootPlannerSpec;
using behaviors::plan_foot;

using Axis = std::array<double, 2>;  // position from the foot, velocity

// ẍ = g/h x by Runge-Kutta of fourth order; 200 steps: error below 1e-10 here.
Axis pendulum(Axis s, double g, double h, double time) {
  const double w2 = g / h;
  const int steps = 200;
  const double dt = time / steps;
  const auto slope = [w2](const Axis& a) { return Axis{a[1], w2 * a[0]}; };
  const auto along = [](const Axis& a, const Axis& b, double t) {
    return Axis{a[0] + t * b[0], a[1] + t * b[1]};
  };
  for (int i = 0; i < steps; ++i) {
    const Axis k1 = slope(s), k2 = slope(along(s, k1, dt / 2)), k3 = slope(along(s, k2, dt / 2)),
               k4 = slope(along(s, k3, dt));
    for (std::size_t k = 0; k < 2; ++k) s[k] += dt / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
  }
  return s;
}

FootPlannerInput standing() {
  FootPlannerInput in;
  in.com = {0.02, 0.08};
  in.com_vel = {0.1, 0.15};
  in.com_height = 0.91;
  in.stance = {0.0, 0.0, 0.0};
  in.switch_in = 0.12;
  in.swing_side = 1.0;
  return in;
}

TEST(FootPlanner, VelocityReversesAfterTheTimeAskedFor) {
  FootPlannerSpec spec;
  spec.reversal = {0.185, 0.18};
  const FootPlannerInput in = standing();
  const FootPlan plan = plan_foot(spec, in);
  ASSERT_TRUE(plan.ok);
  for (std::size_t k = 0; k < 2; ++k) {
    const Axis at_switch = pendulum({in.com[k] - in.stance[k], in.com_vel[k]}, 9.81, 0.91, 0.12);
    EXPECT_NEAR(plan.predicted_pos[k], in.stance[k] + at_switch[0], 1e-10);
    EXPECT_NEAR(plan.predicted_vel[k], at_switch[1], 1e-10);
    const double from_foot = in.stance[k] + at_switch[0] - plan.target[k];
    EXPECT_NEAR(pendulum({from_foot, at_switch[1]}, 9.81, 0.91, spec.reversal[k])[1], 0.0, 1e-10);
    EXPECT_GT(pendulum({from_foot, at_switch[1]}, 9.81, 0.91, 0.9 * spec.reversal[k])[1], 0.0);
  }
}

// Step-to-step map of one axis built from the planner itself: state at a switch, about the goal,
// -> new foot -> pendulum for a step -> state at the next switch. Linear: two columns are enough.
std::array<Axis, 2> map_of_planner(const FootPlannerSpec& spec, std::size_t axis, double height,
                                   double step_time) {
  std::array<Axis, 2> columns{};
  for (std::size_t c = 0; c < 2; ++c) {
    FootPlannerInput in;
    in.com_height = height;
    in.com[axis] = c == 0 ? 0.01 : 0.0;
    in.com_vel[axis] = c == 1 ? 0.01 : 0.0;
    in.switch_in = 0.0;
    const FootPlan plan = plan_foot(spec, in);
    EXPECT_FALSE(plan.clamped);
    const double foot = plan.target[axis];
    const Axis next =
        pendulum({in.com[axis] - foot, in.com_vel[axis]}, spec.gravity, height, step_time);
    columns[c] = {(next[0] + foot) / 0.01, next[1] / 0.01};
  }
  return columns;
}

using Pair = std::array<std::complex<double>, 2>;

Pair eigenvalues_of_planner(const FootPlannerSpec& spec, std::size_t axis, double height,
                            double step_time) {
  const auto columns = map_of_planner(spec, axis, height, step_time);
  const double trace = columns[0][0] + columns[1][1];
  const double det = columns[0][0] * columns[1][1] - columns[1][0] * columns[0][1];
  const std::complex<double> root = std::sqrt(std::complex<double>(0.25 * trace * trace - det));
  return {0.5 * trace + root, 0.5 * trace - root};
}

// In either order.
void expect_same_pair(const Pair& a, Pair b, double tolerance) {
  if (std::abs(a[0] - b[0]) > std::abs(a[0] - b[1])) std::swap(b[0], b[1]);
  EXPECT_NEAR(std::abs(a[0] - b[0]), 0.0, tolerance);
  EXPECT_NEAR(std::abs(a[1] - b[1]), 0.0, tolerance);
}

// How much a map grows in a step, in the long run, without an eigenvalue: ‖A^n‖^(1/n) for
// n = 2^40 by squaring, kept at norm 1.
double growth(std::array<Axis, 2> A) {
  double log_norm = 0.0;  // of A^n, over n
  double n = 1.0;
  for (int k = 0; k < 40; ++k, n *= 2.0) {
    const double norm = std::hypot(std::hypot(A[0][0], A[0][1]), std::hypot(A[1][0], A[1][1]));
    if (norm == 0.0) return 0.0;
    log_norm += std::log(norm) / n;
    for (Axis& column : A) column = {column[0] / norm, column[1] / norm};
    const auto times = [&A](const Axis& v) {
      return Axis{A[0][0] * v[0] + A[1][0] * v[1], A[0][1] * v[0] + A[1][1] * v[1]};
    };
    A = {times(A[0]), times(A[1])};
  }
  return std::exp(log_norm);
}

TEST(FootPlanner, EigenvaluesInClosedFormAreThoseOfThePlannerItself) {
  for (const double kappa : {0.0, 0.2, 0.4, 0.9}) {
    for (const double reversal : {0.18, 0.2, 0.25, 0.5}) {
      for (const double step_time : {0.3, 0.343, 0.4, 0.55}) {
        FootPlannerSpec spec;
        spec.kappa = {kappa, kappa};
        spec.reversal = {reversal, reversal};
        const auto closed = behaviors::step_eigenvalues(kappa, reversal, step_time, 0.9, 9.81);
        expect_same_pair(closed, eigenvalues_of_planner(spec, 0, 0.9, step_time), 1e-8);
        expect_same_pair(closed, eigenvalues_of_planner(spec, 1, 0.9, step_time), 1e-8);
        EXPECT_GE(std::abs(closed[0]), std::abs(closed[1]));
      }
    }
  }
}

// Where the eigenvalues are a conjugate pair their modulus is √det, beyond 1 for a slow reversal.
TEST(FootPlanner, ASlowReversalWithALargeKappaDivergesByAComplexPair) {
  const Pair pair = behaviors::step_eigenvalues(0.9, 0.5, 0.54, 0.91, 9.81);
  EXPECT_GT(std::abs(pair[0].imag()), 0.1);
  EXPECT_EQ(pair[0], std::conj(pair[1]));
  EXPECT_GT(std::abs(pair[0]), 1.2);
  FootPlannerSpec spec;
  spec.kappa = {0.9, 0.9};
  spec.reversal = {0.5, 0.5};
  EXPECT_NEAR(std::abs(pair[0]), growth(map_of_planner(spec, 0, 0.91, 0.54)), 1e-8);
}

// 21 x 21 x 24 settings; the oracle steps the planner and the pendulum, and knows no eigenvalue.
TEST(FootPlanner, OfAllSettingsExactlyThoseThatGrowHaveAnEigenvalueBeyondOne) {
  constexpr double kMargin = 1e-7;  // of the oracle's integration
  int settings = 0, growing = 0, unstable_passed = 0, stable_refused = 0, complex_pairs = 0;
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 21; ++j) {
      for (int k = 0; k < 24; ++k) {
        const double kappa = 0.05 * i, reversal = 0.1 + 0.02 * j, step_time = 0.2 + 0.02 * k;
        FootPlannerSpec spec;
        spec.kappa = {kappa, kappa};
        spec.reversal = {reversal, reversal};
        const double grows = growth(map_of_planner(spec, 0, 0.9, step_time));
        const Pair pair = behaviors::step_eigenvalues(kappa, reversal, step_time, 0.9, 9.81);
        const double modulus = std::abs(pair[0]);
        EXPECT_NEAR(modulus, grows, 1e-6 * grows) << kappa << ' ' << reversal << ' ' << step_time;
        unstable_passed += grows > 1.0 + kMargin && modulus <= 1.0 + 1e-9;
        stable_refused += grows < 1.0 - kMargin && modulus > 1.0 + 1e-9;
        growing += grows > 1.0 + kMargin;
        complex_pairs += pair[0].imag() != 0.0;
        ++settings;
      }
    }
  }
  EXPECT_EQ(settings, 10584);
  EXPECT_EQ(unstable_passed, 0);
  EXPECT_EQ(stable_refused, 0);
  EXPECT_GT(growing, 1000);
  EXPECT_GT(settings - growing, 1000);
  EXPECT_GT(complex_pairs, 1000);
}

// The three conditions in words: behaviors/planners/foot_planner.h.
TEST(FootPlanner, StabilityIsThreeInequalities) {
  for (const double kappa : {-0.2, 0.1, 0.5, 0.9}) {
    for (const double reversal : {0.15, 0.2, 0.3, 0.5}) {
      for (const double step_time : {0.25, 0.35, 0.45, 0.55}) {
        const double w = std::sqrt(9.81 / 0.9);
        const bool stable =
            kappa >= 0.0 && reversal >= step_time / 2 &&
            (1 + kappa) * std::tanh(w * step_time / 2) * std::tanh(w * reversal) <= 1;
        const Pair pair = behaviors::step_eigenvalues(kappa, reversal, step_time, 0.9, 9.81);
        EXPECT_EQ(std::abs(pair[0]) <= 1.0 + 1e-9, stable) << kappa << ' ' << reversal;
      }
    }
  }
}

// Printed to two digits; height and step time are those of E2 in docs/notation.md.
TEST(FootPlanner, ReproducesTableTwo) {
  FootPlannerSpec spec;
  spec.kappa = {0.4, 0.4};
  spec.reversal = {0.185, 0.18};
  expect_same_pair(eigenvalues_of_planner(spec, 0, 0.911, 0.3431), {0.69, -0.81}, 0.005);
  expect_same_pair(eigenvalues_of_planner(spec, 1, 0.911, 0.3431), {0.70, -0.88}, 0.005);
}

TEST(FootPlanner, ThePrintedSignOfKappaIsUnstable) {
  FootPlannerSpec spec;
  spec.kappa = {-0.4, -0.4};
  spec.reversal = {0.185, 0.18};
  const auto pair = eigenvalues_of_planner(spec, 0, 0.935, 0.335);
  EXPECT_NEAR(std::max(pair[0].real(), pair[1].real()), 1.28, 0.01);
  EXPECT_GT(std::abs(behaviors::step_eigenvalues(-0.4, 0.185, 0.335, 0.935, 9.81)[0]), 1.0);
}

TEST(FootPlanner, WithoutKappaOneEigenvalueIsOneAndStepsDrift) {
  expect_same_pair(
      behaviors::step_eigenvalues(0.0, 0.2, 0.343, 0.91, 9.81),
      {1.0, -std::sinh(std::sqrt(9.81 / 0.91) * 0.143) / std::sinh(std::sqrt(9.81 / 0.91) * 0.2)},
      1e-12);
}

TEST(FootPlanner, AFootGoesToTheFarSideOfTheCentreOfMassFromTheGoal) {
  FootPlannerSpec spec;
  FootPlannerInput in = standing();
  const double without = plan_foot(spec, in).target[0];
  spec.kappa = {0.4, 0.4};
  in.goal = {1.0, 0.0};
  EXPECT_LT(plan_foot(spec, in).target[0], without);
}

TEST(FootPlanner, TheWidthOffsetGoesOutwardOnBothSides) {
  FootPlannerSpec spec;
  FootPlannerInput in = standing();
  const double left = plan_foot(spec, in).target[1];
  in.swing_side = -1.0;
  const double right = plan_foot(spec, in).target[1];
  spec.width_offset = 0.03;
  EXPECT_NEAR(plan_foot(spec, in).target[1], right - 0.03, 1e-12);
  in.swing_side = 1.0;
  EXPECT_NEAR(plan_foot(spec, in).target[1], left + 0.03, 1e-12);
}

TEST(FootPlanner, ATargetOutOfReachBecomesTheClosestReachableOne) {
  FootPlannerSpec free_spec;
  FootPlannerSpec spec;
  spec.reach_x = 0.1;
  spec.min_width = 0.1;
  spec.max_width = 0.3;
  FootPlannerInput in = standing();
  in.yaw = 0.7;
  for (const double side : {1.0, -1.0}) {
    for (const double vx : {-1.0, 0.0, 1.0}) {
      for (const double vy : {-1.0, 0.0, 1.0}) {
        in.swing_side = side;
        in.com_vel = {vx, vy};
        const FootPlan wanted = plan_foot(free_spec, in);
        const FootPlan plan = plan_foot(spec, in);
        const double c = std::cos(in.yaw), s = std::sin(in.yaw);
        const auto heading = [&](const FootPlan& p) {
          return Axis{c * p.target[0] + s * p.target[1], -s * p.target[0] + c * p.target[1]};
        };
        const Axis w = heading(wanted), got = heading(plan);
        double best = 1e9;  // over a fine grid of the box
        for (int i = 0; i <= 200; ++i) {
          for (int j = 0; j <= 200; ++j) {
            const double x = -0.1 + 0.001 * i, y = side * (0.1 + 0.001 * j);
            best = std::min(best, std::hypot(x - w[0], y - w[1]));
          }
        }
        EXPECT_LE(std::abs(got[0]), 0.1 + 1e-12);
        EXPECT_GE(side * got[1], 0.1 - 1e-12);
        EXPECT_LE(side * got[1], 0.3 + 1e-12);
        EXPECT_LE(std::hypot(got[0] - w[0], got[1] - w[1]), best + 1e-12);
        EXPECT_EQ(plan.clamped, std::hypot(got[0] - w[0], got[1] - w[1]) > 1e-12);
      }
    }
  }
}

TEST(FootPlanner, APlanTurnsWithTheRobot) {
  FootPlannerSpec spec;
  spec.kappa = {0.4, 0.2};
  spec.reversal = {0.185, 0.22};
  spec.width_offset = 0.02;
  spec.goal_error_limit = 0.1;
  spec.reach_x = 0.2;
  spec.min_width = 0.1;
  spec.max_width = 0.35;
  FootPlannerInput in = standing();
  in.goal = {0.5, 0.3};
  const FootPlan straight = plan_foot(spec, in);
  for (const double yaw : {0.4, 2.0, -2.5}) {
    const double c = std::cos(yaw), s = std::sin(yaw);
    const auto turn = [c, s](const Axis& v) {
      return Axis{c * v[0] - s * v[1], s * v[0] + c * v[1]};
    };
    FootPlannerInput turned = in;
    turned.yaw = yaw;
    turned.com = turn(in.com);
    turned.com_vel = turn(in.com_vel);
    turned.goal = turn(in.goal);
    const FootPlan plan = plan_foot(spec, turned);
    const Axis expected = turn({straight.target[0], straight.target[1]});
    EXPECT_NEAR(plan.target[0], expected[0], 1e-12);
    EXPECT_NEAR(plan.target[1], expected[1], 1e-12);
  }
}

TEST(FootPlanner, OnlyWhereTheRobotIsRelativeToItsFootMatters) {
  FootPlannerSpec spec;
  spec.kappa = {0.4, 0.4};
  FootPlannerInput in = standing();
  const FootPlan here = plan_foot(spec, in);
  in.stance = {3.0, -2.0, 0.07};
  for (std::size_t k = 0; k < 2; ++k) {
    in.com[k] += in.stance[k];
    in.goal[k] += in.stance[k];
  }
  const FootPlan there = plan_foot(spec, in);
  EXPECT_NEAR(there.target[0], here.target[0] + 3.0, 1e-12);
  EXPECT_NEAR(there.target[1], here.target[1] - 2.0, 1e-12);
  EXPECT_DOUBLE_EQ(there.target[2], 0.07);
}

TEST(FootPlanner, AFarGoalPullsNoHarderThanItsLimit) {
  FootPlannerSpec spec;
  spec.kappa = {0.4, 0.4};
  spec.goal_error_limit = 0.3;
  FootPlannerInput in = standing();
  const FootPlan plan = plan_foot(spec, in);
  in.goal = {100.0, -100.0};
  const FootPlan far = plan_foot(spec, in);
  FootPlannerSpec without = spec;
  without.kappa = {0.0, 0.0};
  const FootPlan base = plan_foot(without, in);
  EXPECT_NEAR(far.target[0] - base.target[0], -0.4 * 0.3, 1e-12);
  EXPECT_NEAR(far.target[1] - base.target[1], 0.4 * 0.3, 1e-12);
  EXPECT_TRUE(plan.ok);
}

// The swing-time rule: landing lasts until the predicted lateral speed is reached.
TEST(FootPlanner, TheExtensionEndsWhenTheLateralSpeedIsReached) {
  FootPlannerSpec spec;
  spec.extension_speed = 0.3;
  spec.extension_limit = 0.5;
  FootPlannerInput in = standing();
  in.com_vel = {0.0, 0.05};
  in.switch_in = 0.02;
  const FootPlan plan = plan_foot(spec, in);
  EXPECT_GT(plan.extension, 0.0);
  const Axis at = pendulum({in.com[1], in.com_vel[1]}, 9.81, 0.91, 0.02 + plan.extension);
  EXPECT_NEAR(at[1], 0.3, 1e-10);
  EXPECT_NEAR(plan.predicted_vel[1], 0.3, 1e-10);
  spec.extension_limit = 0.5 * plan.extension;
  EXPECT_DOUBLE_EQ(plan_foot(spec, in).extension, spec.extension_limit);
  in.com_vel[1] = 0.5;
  EXPECT_DOUBLE_EQ(plan_foot(spec, in).extension, 0.0);
  spec.extension_speed = 0.0;
  EXPECT_DOUBLE_EQ(plan_foot(spec, in).extension, 0.0);
}

TEST(FootPlanner, TheExtensionAlsoFindsASpeedAfterTheTurn) {
  FootPlannerSpec spec;
  spec.extension_speed = 0.3;
  spec.extension_limit = 5.0;
  FootPlannerInput in = standing();
  in.com = {0.0, 0.1};
  in.com_vel = {0.0, -0.05};  // still inwards, will turn before the foot
  in.switch_in = 0.0;
  const FootPlan plan = plan_foot(spec, in);
  const Axis at = pendulum({0.1, -0.05}, 9.81, 0.91, plan.extension);
  EXPECT_NEAR(std::abs(at[1]), 0.3, 1e-9);
}

TEST(FootPlanner, NumbersThatAreNoneGiveNoPlan) {
  FootPlannerInput in = standing();
  in.com_vel[1] = std::nan("");
  EXPECT_FALSE(plan_foot({}, in).ok);
  in = standing();
  in.com_height = 0.0;
  EXPECT_FALSE(plan_foot({}, in).ok);
  in.com_height = std::nan("");
  EXPECT_FALSE(plan_foot({}, in).ok);
}

}  // namespace
}  // namespace footfall::tests
