// Torque loops: their laws, their integrals at the limit, changes of gains.
#include "hal/actuators/torque_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hal/actuators/series_elastic.h"
#include "tests/support/allocation_guard.h"
#include "tests/unit/hal/actuator_test_support.h"

namespace footfall::tests {
namespace {

using hal::TorqueLoop;
using hal::TorqueLoopGains;
using hal::TorqueLoopInput;

TEST(TorqueLoop, TheFirstOutputIsTheProportionalPart) {
  const TorqueLoopInput input{
      .reference = 10.0, .torque = 4.0, .motor_rate = 0.5, .spring_rate = 0.3};
  EXPECT_DOUBLE_EQ(TorqueLoop(kCascade, kLoopStep).ask(input), 25.0 * (0.8 * 6.0 - 0.5));
  EXPECT_DOUBLE_EQ(TorqueLoop(kDirect, kLoopStep).ask(input), 10.0 + 20.0 * 6.0 - 25.0 * 0.5);
  TorqueLoopGains spring = kDirect;
  spring.damps = TorqueLoopGains::Damping::spring;
  EXPECT_NEAR(TorqueLoop(spring, kLoopStep).ask(input), 10.0 + 20.0 * 6.0 - 25.0 * 0.3, 1e-12);
}

TEST(TorqueLoop, IntegralsAreOfTheErrorsTimesTheirGains) {
  const TorqueLoopInput input{.reference = 1.0};
  TorqueLoop direct(kDirect, kLoopStep);
  const double first = one_step(direct, input);
  for (int k = 1; k < 1200; ++k) one_step(direct, input);
  EXPECT_NEAR(one_step(direct, input) - first, 10.0 * 1.0 * 1200 * kLoopStep, 1e-9);
  TorqueLoop cascade(kCascade, kLoopStep);
  // With constant errors the outer integral is linear and the inner one quadratic in time.
  double outer = 0.0, inner = 0.0, expected = 0.0;
  for (int k = 0; k < 1200; ++k) {
    const double slip = 0.8 + outer;
    expected = 25.0 * slip + inner;
    EXPECT_NEAR(one_step(cascade, input), expected, 1e-9);
    inner += 50.0 * slip * kLoopStep;
    outer += 2.0 * kLoopStep;
  }
}

// Hume's knee with its output locked.
double after(TorqueLoop& loop, hal::SeriesElasticActuator& actuator, double reference,
             double time) {
  double largest = 0.0;
  for (int k = 0; k < time / kLoopStep; ++k) {
    const double torque = actuator.spring_torque();
    largest = std::max(largest, torque);
    const double rate = actuator.state().rate;
    const TorqueLoopInput input{reference, torque, rate, rate};
    const double asked = loop.ask(input);
    loop.settle(input, asked, actuator.advance(asked, 0.0).motor_torque);
  }
  return largest;
}

TEST(TorqueLoop, BothReachTheirReferenceOnALockedOutput) {
  for (const TorqueLoopGains& gains : {kCascade, kDirect}) {
    hal::SeriesElasticActuator actuator(
        {.spring = 415.0, .rotor = 0.0872756, .viscous = 0.5, .coulomb = 1.0}, kLoopStep);
    TorqueLoop loop(gains, kLoopStep);
    after(loop, actuator, 30.0, 3.0);
    EXPECT_NEAR(actuator.spring_torque(), 30.0, 0.15);
  }
}

// Coulomb friction makes a loop without integral miss by a part of it, F = f/(1 + P).
TEST(TorqueLoop, AnObserverCancelsTheFrictionOfTheRotor) {
  const hal::SeriesElasticParameters rough{
      .spring = 415.0, .rotor = 0.0872756, .viscous = 0.5, .coulomb = 5.0};
  TorqueLoopGains gains = kDirect;
  gains.i = 0.0;
  const auto missed = [&] {
    hal::SeriesElasticActuator actuator(rough, kLoopStep);
    TorqueLoop loop(gains, kLoopStep, rough.rotor);
    // A slow ramp, so that the rotor turns and friction has its full amount.
    double reference = 0.0;
    for (; reference < 30.0; reference += 5.0 * kLoopStep) {
      after(loop, actuator, reference, 0.5 * kLoopStep);
    }
    return reference - actuator.spring_torque();
  };
  const double without = missed();
  gains.observer = 20.0;
  const double with = missed();
  EXPECT_NEAR(without, 5.0 / 21.0, 0.15);  // and the lag of the ramp
  EXPECT_LT(std::abs(with), 0.25 * without);
}

// At the limit the integrals stand still; without that the overshoot would grow with the time spent
// there.
TEST(TorqueLoop, IntegralsDoNotWindUpAtTheLimit) {
  for (const TorqueLoopGains& gains : {kCascade, kDirect}) {
    double overshoot[2];
    for (const int k : {0, 1}) {
      hal::SeriesElasticActuator actuator(
          {.spring = 415.0, .rotor = 0.0872756, .viscous = 0.5, .torque = 20.0}, kLoopStep);
      TorqueLoop loop(gains, kLoopStep);
      after(loop, actuator, 60.0, k == 0 ? 3.0 : 10.0);  // more than the motor can
      after(loop, actuator, 10.0, 0.05);
      overshoot[k] = after(loop, actuator, 10.0, 2.0);
    }
    EXPECT_NEAR(overshoot[1], overshoot[0], 0.5);
  }
}

TEST(TorqueLoop, AChangeOfGainsLeavesTheCommandContinuous) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const auto any = [&]() -> TorqueLoopGains {
    if (part(random) < 0.5) {
      return {.type = TorqueLoopGains::Type::cascade,
              .p = part(random),
              .i = part(random) < 0.5 ? 0.0 : 5.0 * part(random),
              .velocity_p = 20.0 * part(random),
              .velocity_i = part(random) < 0.5 ? 0.0 : 40.0 * part(random)};
    }
    return {.type = TorqueLoopGains::Type::direct,
            .p = 40.0 * part(random),
            .i = part(random) < 0.5 ? 0.0 : 20.0 * part(random),
            .forward = part(random),
            .damping = 20.0 * part(random),
            .observer = part(random) < 0.5 ? 0.0 : 30.0 * part(random)};
  };
  double worst = 0.0;
  for (int trial = 0; trial < 1000; ++trial) {
    TorqueLoop loop(any(), kLoopStep, 0.1), kept = loop;
    TorqueLoopInput input{10.0 * normal(random), 10.0 * normal(random), normal(random),
                          normal(random)};
    for (int k = 0; k < 100; ++k) one_step(loop, input);
    kept = loop;
    const TorqueLoopGains other = any();
    loop.change(other, input);
    const double jump = std::abs(one_step(loop, input) - one_step(kept, input));
    EXPECT_LT(jump, 1e-9);
    worst = std::max(worst, jump);
    // What was added is gone after some time constants: the law of the new gains alone is left.
    if (other.i != 0.0 || other.velocity_i != 0.0 || other.observer != 0.0) continue;
    for (int k = 0; k < 12000; ++k) one_step(loop, input);  // 50 time constants
    EXPECT_NEAR(one_step(loop, input), TorqueLoop(other, kLoopStep).ask(input), 1e-9);
  }
  RecordProperty("worst", std::to_string(1e9 * worst));  // nN m
}

TEST(TorqueLoop, AStepAllocatesNothing) {
  TorqueLoop loop(kCascade, kLoopStep);
  const AllocationGuard guard;
  for (int k = 0; k < 100; ++k) one_step(loop, {1.0, 0.5, 0.1, 0.1});
  loop.change(kDirect, {1.0, 0.5, 0.1, 0.1});
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
