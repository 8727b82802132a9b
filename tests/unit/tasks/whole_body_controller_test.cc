// Assembly of control laws, contact transitions in both forms, and reports.
// Equations: [Kim16] eqs. (1), (2) with E8; eqs. (7)-(10) with E10.
#include "tasks/whole_body_controller.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/allocation_guard.h"
#include "tests/support/dense_solve.h"
#include "tests/support/hume_control.h"
#include "tests/support/naive_wbosc.h"

namespace footfall::tests {
namespace {

using tasks::ActiveControl;
using tasks::ControlSet;
using tasks::TransitionForm;

constexpr double kBar = 1e-9;

// Every axis asks for `acceleration` and nothing else.
void ask_only(ControlSet& set, const std::vector<double>& acceleration) {
  for (int i = 0; i < set.axis_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    set.axes[k].kp = set.axes[k].ki = set.axes[k].kd = 0.0;
    set.axes[k].ref_acc = k < acceleration.size() ? acceleration[k] : 0.0;
  }
}

class Controller : public testing::Test {
 protected:
  void SetUp() override {
    model_.update(random_state(robot_, random_));
    fill_dual_set(dual_);
    fill_single_set(single_, model_.point(kLeftFoot).position);
  }
  Matrix torque_of(const ControlSet& set) {
    control_.primary = set;
    control_.has_other = false;
    compute(control_);
    return tau();
  }
  void compute(const ActiveControl& control) {
    const std::array<double, 6> measured{};
    controller_.compute(control, tick_++, measured.data(), tau_.data());
  }
  Matrix tau() const { return Matrix::vector(tau_.data(), 6); }
  // As the controller should have assembled the single-support law.
  NaiveProblem single_problem(const std::vector<double>& u) {
    tasks::Wbosc solver(hume_sizes());
    ProblemBuilder b(model_, solver.problem());
    b.contact(kRightFoot);
    b.row(model_.com(), {0.0, 0.0, 1.0}, u[0]);
    b.row(model_.base_rotation(), b.heading(1), u[1]);
    b.row(model_.base_rotation(), b.heading(0), u[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<double, 3> axis{};
      axis[k] = 1.0;
      b.row(model_.point(kLeftFoot), axis, u[3 + k]);
    }
    b.end_level();
    return dense_problem(model_, solver.problem());
  }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  tasks::WholeBodyController controller_{model_, {}, {4, 16, 2, 2}, 1.0 / 1500.0};
  std::array<double, 6> tau_{};
  Random random_{11};
  ControlSet dual_, single_;
  ActiveControl control_;
  std::int64_t tick_ = 0;
};

TEST_F(Controller, ReportsTheAccelerationsThatWereAskedFor) {
  torque_of(single_);
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double u = controller_.result().axes[k].commanded;
    EXPECT_NEAR(controller_.result().achieved[k], u, kBar * 1000.0);
  }
  EXPECT_EQ(controller_.result().tasks[0].rank, 6);
  EXPECT_DOUBLE_EQ(controller_.result().tasks[2].authority, 1.0);
  EXPECT_GE(controller_.result().tasks[0].condition, 1.0);
}

TEST_F(Controller, AssemblesTheLawsOfAppendixA) {
  const std::vector<double> u = {1.0, -2.0, 0.5, 3.0, -1.0, 2.0};
  ask_only(single_, u);
  const Matrix expected = naive_wbosc(single_problem(u)).tau;
  EXPECT_LE((torque_of(single_) - expected).max_abs(), kBar * expected.max_abs());
}

// Capacity for exactly two levels: neither may be folded into the other.
TEST_F(Controller, KeepsAsManyLevelsAsItWasBuiltFor) {
  torque_of(dual_);
  EXPECT_EQ(controller_.result().tasks[0].rank, 4);
  EXPECT_EQ(controller_.result().tasks[1].rank, 4);
  EXPECT_EQ(controller_.result().tasks[2].rank, 1);
  EXPECT_NEAR(controller_.result().tasks[2].authority, 1.0 / 6.0, 1e-15);
}

// F + K (F - y), y the low-pass of the tension of the measured torques, which are those of the tick
// before with an error that alone makes the tension wrong by d: stepped by hand as numbers. It
// begins with y = F and ends at d/(1 + K); a gain far above 1 neither jumps nor alternates.
TEST_F(Controller, MeasuredTensionIsFedBackThroughALowPass) {
  constexpr double kWanted = 40.0, kGain = 8.0, kBandwidth = 20.0;
  dual_.internal_count = 1;
  tasks::InternalCommand& force = dual_.internals[0];
  force = {.contacts = {kRightFoot, kLeftFoot}, .reference = kWanted};
  const std::array<double, 6> error = {5.0, -10.0, 15.0, -5.0, 10.0, 20.0};
  ActiveControl control;
  control.primary = dual_;
  std::array<double, 6> measured{};
  const auto tick = [&] {
    controller_.compute(control, tick_++, measured.data(), tau_.data());
    for (std::size_t j = 0; j < 6; ++j) measured[j] = tau_[j] + error[j];
    return controller_.result().internal_measured[0];
  };
  tick();
  const double d = tick() - kWanted;
  ASSERT_GT(std::abs(d), 1.0);
  control.primary.internal_count = 0;
  tick();  // the pair is out of force: its low-pass begins anew
  control.primary = dual_;
  control.primary.internals[0].feedback = kGain;
  control.primary.internals[0].bandwidth = kBandwidth;
  const double a = std::exp(-2.0 * std::numbers::pi * kBandwidth * robot_.period_s());
  double y = kWanted, last = 0.0;
  for (int n = 0; n < 300; ++n) {
    const double m = tick();
    if (n > 0) {
      EXPECT_NEAR(m, kWanted + kGain * (kWanted - y) + d, 1e-7) << n;
    }
    y = a * y + (1.0 - a) * m;
    last = m;
  }
  EXPECT_NEAR(last - kWanted, d / (1.0 + kGain), 1e-6);
}

// A step of the reference is no error: the torque measured is that of the reference before. With
// ideal torques, a tick old, the force goes to the new reference at once and stays there.
TEST_F(Controller, AStepOfTheReferenceIsNotFedBack) {
  ActiveControl control;
  control.primary = dual_;
  control.primary.internal_count = 1;
  tasks::InternalCommand& force = control.primary.internals[0];
  force = {
      .contacts = {kRightFoot, kLeftFoot}, .reference = 50.0, .feedback = 5.0, .bandwidth = 20.0};
  std::array<double, 6> measured{};
  const auto run = [&](int ticks) {
    double farthest = 0.0;
    for (int n = 0; n < ticks; ++n) {
      controller_.compute(control, tick_++, measured.data(), tau_.data());
      std::copy_n(tau_.begin(), 6, measured.begin());
      farthest = std::max(farthest, std::abs(controller_.result().internal[0] - force.reference));
    }
    return farthest;
  };
  run(300);
  force.reference = 30.0;
  EXPECT_LE(run(300), 1e-3);
}

TEST_F(Controller, APairInTheOtherOrderIsTheSameForce) {
  ActiveControl control;
  control.primary = dual_;
  control.primary.internal_count = 1;
  tasks::InternalCommand& force = control.primary.internals[0];
  force = {
      .contacts = {kRightFoot, kLeftFoot}, .reference = 40.0, .integral = 30.0, .bandwidth = 20.0};
  const std::array<double, 6> error = {5.0, -10.0, 15.0, -5.0, 10.0, 20.0};
  std::array<double, 6> measured{};
  const auto tick = [&] {
    controller_.compute(control, tick_++, measured.data(), tau_.data());
    for (std::size_t j = 0; j < 6; ++j) measured[j] = tau_[j] + error[j];
    return controller_.primary().solution().internal_integral[0];
  };
  for (int n = 0; n < 200; ++n) tick();
  const double before = tick();
  ASSERT_GT(std::abs(before), 0.5);
  force.contacts = {kLeftFoot, kRightFoot};
  EXPECT_NEAR(tick(), before, 0.05 * std::abs(before));
}

// The integral takes the error to nothing. Stepped by hand: the same loop with I beside K.
TEST_F(Controller, AnIntegralLeavesNoErrorOfTheTension) {
  constexpr double kWanted = 40.0, kGain = 2.0, kIntegral = 30.0;
  const double T = robot_.period_s();
  const double a = std::exp(-2.0 * std::numbers::pi * 20.0 * T);
  const std::array<double, 6> error = {5.0, -10.0, 15.0, -5.0, 10.0, 20.0};
  ActiveControl control;
  control.primary = dual_;
  control.primary.internal_count = 1;
  control.primary.internals[0] = {.contacts = {kRightFoot, kLeftFoot},
                                  .reference = kWanted,
                                  .feedback = kGain,
                                  .integral = kIntegral,
                                  .bandwidth = 20.0};
  std::array<double, 6> measured{};
  double y = kWanted, integral = 0.0, asked = kWanted, d = 0.0, m = 0.0;
  for (int n = 0; n < 2000; ++n) {
    controller_.compute(control, tick_++, measured.data(), tau_.data());
    for (std::size_t j = 0; j < 6; ++j) measured[j] = tau_[j] + error[j];
    m = controller_.result().internal_measured[0];
    if (n == 1) d = m - asked;
    if (n > 1) {
      EXPECT_NEAR(m, asked + d, 1e-7) << n;
    }
    y = a * y + (1.0 - a) * m;
    integral += kIntegral * T * (kWanted - y);
    asked = kWanted + kGain * (kWanted - y) + integral;
  }
  // The slowest root's rate is K_I / (1 + K): exp(-10 x 1.33 s).
  EXPECT_NEAR(m, kWanted, 1e-4 * std::abs(d));
}

// A motor at its limit cannot give more: what is integrated then would have to be undone later.
TEST_F(Controller, TheIntegralOfAForceWaitsWhileAJointIsAtItsLimit) {
  constexpr double kTooMuch = 5000.0;  // N
  ActiveControl control;
  control.primary = dual_;
  control.primary.internal_count = 1;
  control.primary.internals[0] = {.contacts = {kRightFoot, kLeftFoot},
                                  .reference = kTooMuch,
                                  .integral = 100.0,
                                  .integral_limit = 90.0,
                                  .bandwidth = 20.0};
  tasks::WholeBodyController limited{
      model_, std::vector<double>(6, 50.0), {3, 12, 3, 2}, robot_.period_s()};
  std::array<double, 6> measured{};
  const auto run = [&](tasks::WholeBodyController& controller) {
    for (int n = 0; n < 100; ++n) {
      controller.compute(control, tick_++, measured.data(), tau_.data());
    }
    return controller.primary().solution().internal_integral[0];
  };
  const double waits = run(limited);
  EXPECT_TRUE(limited.result().limited);
  // One tick passes before the limit is known.
  EXPECT_LE(std::abs(waits), 100.0 * robot_.period_s() * kTooMuch);
  EXPECT_EQ(run(limited), waits);
  EXPECT_EQ(std::abs(run(controller_)), 90.0);  // without limits of torque: that of the integral
}

TEST_F(Controller, AForceGrowsInItsRampFromZero) {
  ActiveControl control;
  control.primary = dual_;
  control.primary.internal_count = 1;
  const double T = robot_.period_s();
  control.primary.internals[0] = {
      .contacts = {kRightFoot, kLeftFoot}, .reference = 60.0, .ramp = 6.0 * T};
  for (int n = 0; n < 10; ++n) {
    compute(control);
    EXPECT_NEAR(controller_.result().internal[0], 10.0 * std::min(n, 6), 1e-7);
    EXPECT_NEAR(controller_.result().internal_reference[0], 10.0 * std::min(n, 6), 1e-12);
  }
  control.primary.internal_count = 0;
  compute(control);
  control.primary.internal_count = 1;
  compute(control);
  EXPECT_NEAR(controller_.result().internal[0], 0.0, 1e-7) << "in force anew";
}

TEST_F(Controller, TensionNotNamedIsZeroAndNamedTensionIsReported) {
  torque_of(dual_);
  const auto& force = controller_.result().force;
  const auto apart = [&]() {
    Matrix x(3), df(3);
    for (int k = 0; k < 3; ++k) {
      const auto q = static_cast<std::size_t>(k);
      x(k) = model_.point(kRightFoot).position[q] - model_.point(kLeftFoot).position[q];
      df(k) = force[kRightFoot][q] - force[kLeftFoot][q];
    }
    return -0.5 * dot(x, df) / x.norm();
  };
  EXPECT_NEAR(apart(), 0.0, 1e-7);
  SetBuilder builder(dual_);
  fill_dual_set(dual_);
  dual_.internal_count = 1;
  dual_.internals[0] = {.contacts = {kRightFoot, kLeftFoot}, .reference = 75.0};
  torque_of(dual_);
  EXPECT_NEAR(apart(), 75.0, 1e-7);
  EXPECT_NEAR(controller_.result().internal[0], 75.0, 1e-7);
}

TEST_F(Controller, ABlendIsExactAtBothEnds) {
  const Matrix single = torque_of(single_);
  const Matrix dual = torque_of(dual_);
  ASSERT_GT((single - dual).max_abs(), 1.0);
  control_.primary = single_;
  control_.other = dual_;
  control_.has_other = true;
  for (auto* set : {&control_.primary, &control_.other}) {
    for (auto& axis : set->axes) axis.ki = 0.0;
  }
  control_.other_weight = 0.0;
  compute(control_);
  const Matrix at_zero = tau();
  const Matrix primary = Matrix::vector(controller_.tau_primary(), 6);
  EXPECT_EQ((at_zero - primary).max_abs(), 0.0);
  control_.other_weight = 1.0;
  compute(control_);
  const Matrix other = Matrix::vector(controller_.tau_other(), 6);
  EXPECT_EQ((tau() - other).max_abs(), 0.0);
  control_.other_weight = 0.25;
  compute(control_);
  EXPECT_LE((tau() - (0.75 * primary + 0.25 * other)).max_abs(), 1e-12);
  // Each law alone is what it is without a transition.
  const ControlSet plain_dual = control_.other, plain_single = control_.primary;
  EXPECT_LE((torque_of(plain_dual) - other).max_abs(), 1e-12);
  EXPECT_LE((torque_of(plain_single) - primary).max_abs(), 1e-12);
}

TEST_F(Controller, ABlendSharesTheMovingFootsForce) {
  control_.primary = single_;
  control_.other = dual_;
  control_.has_other = true;
  control_.other_weight = 0.5;
  compute(control_);
  const double half = controller_.result().force[kLeftFoot][2];
  control_.other_weight = 1.0;
  compute(control_);
  EXPECT_NEAR(half, 0.5 * controller_.result().force[kLeftFoot][2], 1.0);
}

// E8: with equal task commands and a foot that does not accelerate, the frozen form at w = 1 is the
// dual controller, and in between it is the corrected formula
//   f_trans = w Λ* J A⁻¹ N_sᵀ J_swᵀ f_sw   (f_sw: the swing foot's part of F_r).
TEST_F(Controller, TheFrozenFormIsTheDualControllerAtFullWeight) {
  const std::vector<double> u = {1.0, -2.0, 0.5, 0.0, 0.0, 0.0};
  ask_only(single_, u);
  ask_only(dual_, {1.0, 0.7, -2.0, 0.5});
  const Matrix dual = torque_of(dual_);
  const auto f_sw = controller_.result().force[kLeftFoot];

  control_.primary = single_;
  control_.other = dual_;
  control_.has_other = true;
  control_.form = TransitionForm::frozen;
  control_.transition_entered = true;
  control_.moving_contact_count = 1;
  control_.moving_contacts[0] = kLeftFoot;
  control_.other_weight = 1.0;
  compute(control_);
  EXPECT_LE((tau() - dual).max_abs(), kBar * dual.max_abs());

  const NaiveProblem p = single_problem(u);
  const Matrix Ainv = inverse(p.A);
  const Matrix Lambda_s = inverse(p.Js * Ainv * p.Js.transpose());
  const Matrix Ns = Matrix::identity(12) - Ainv * p.Js.transpose() * Lambda_s * p.Js;
  const Matrix UNs = p.U * Ns;
  const Matrix phi = UNs * Ainv * UNs.transpose();
  const Matrix J_star = p.levels[0].J * Ainv * UNs.transpose() * inverse(phi);
  const Matrix Lambda = inverse(J_star * phi * J_star.transpose());
  const Matrix J_sw = p.levels[0].J.tail(3);
  const Matrix on_ground = -Matrix::vector(f_sw.data(), 3);
  control_.transition_entered = false;
  for (const double w : {0.75, 0.3, 0.0}) {
    control_.other_weight = w;
    compute(control_);
    const Matrix f_trans =
        w * Lambda * p.levels[0].J * Ainv * Ns.transpose() * J_sw.transpose() * on_ground;
    const Matrix expected = naive_wbosc(p).tau + J_star.transpose() * f_trans;
    EXPECT_LE((tau() - expected).max_abs(), kBar * dual.max_abs());
    // The moving foot's force is reported: what the law counts on.
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_DOUBLE_EQ(controller_.result().force[kLeftFoot][k], w * f_sw[k]);
    }
  }
}

TEST_F(Controller, TheFrozenForceStaysThatOfEntry) {
  control_.primary = single_;
  control_.other = dual_;
  control_.has_other = true;
  control_.form = TransitionForm::frozen;
  control_.transition_entered = true;
  control_.moving_contact_count = 1;
  control_.moving_contacts[0] = kLeftFoot;
  control_.other_weight = 1.0;
  ask_only(control_.primary, {});
  ask_only(control_.other, {});
  compute(control_);
  control_.transition_entered = false;
  control_.other_weight = 0.5;
  compute(control_);
  const Matrix before = tau();
  ask_only(control_.other, {5.0});  // the other law is not looked at any more
  compute(control_);
  EXPECT_EQ((tau() - before).max_abs(), 0.0);
}

TEST_F(Controller, FromTheStanceFeetTheTorquesAreThoseOfTheWorldWithTheReferenceMovedAlong) {
  for (auto& axis : dual_.axes) axis.kd = 0.0;  // how fast the feet slip is no error of the world's
  const Matrix world = torque_of(dual_);
  dual_.tasks[0].frame = tasks::Frame::stance;
  dual_.axes[0].ref -=
      0.5 * (model_.point(kRightFoot).position[2] + model_.point(kLeftFoot).position[2]);
  for (int i = 0; i < dual_.task_count; ++i) dual_.tasks[static_cast<std::size_t>(i)].fresh = true;
  const Matrix stance = torque_of(dual_);
  EXPECT_LE((stance - world).max_abs(), kBar * world.max_abs());
}

TEST_F(Controller, LimitsAreReported) {
  tasks::WholeBodyController limited(model_, std::vector<double>(6, 1.0), {4, 16, 2, 2},
                                     1.0 / 1500.0);
  control_.primary = single_;
  limited.compute(control_, 0, nullptr, tau_.data());
  EXPECT_TRUE(limited.result().limited);
  const Matrix asked = tau();
  EXPECT_LE((asked - torque_of(single_)).max_abs(), 1e-12 * asked.max_abs());
  EXPECT_GT(asked.max_abs(), 1.0);  // what was asked for, not what a joint can give
}

TEST_F(Controller, AnEmptyControlSetIsLimp) { EXPECT_EQ(torque_of(ControlSet{}).max_abs(), 0.0); }

TEST_F(Controller, ComputingAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  control_.primary = single_;
  control_.other = dual_;
  control_.has_other = true;
  control_.other_weight = 0.5;
  const AllocationGuard guard;
  for (int i = 0; i < 20; ++i) {
    control_.form = i % 2 == 0 ? TransitionForm::continuous : TransitionForm::frozen;
    compute(control_);
  }
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
