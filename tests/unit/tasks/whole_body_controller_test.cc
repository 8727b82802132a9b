// Assembly of control laws, contact transitions in both forms, and reports.
// Equations: [Kim16] eqs. (1), (2) with E8; eqs. (7)-(10) with E10.
#include "tasks/whole_body_controller.h"

#include <array>
#include <cmath>

#include "tests/support/allocation_guard.h"
#include "tests/unit/tasks/controller_fixture.h"

namespace footfall::tests {
namespace {

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
