// Internal forces of the controller: feedback of what is measured, integral, ramp, names.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/unit/tasks/controller_fixture.h"

namespace footfall::tests {
namespace {

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

}  // namespace
}  // namespace footfall::tests
