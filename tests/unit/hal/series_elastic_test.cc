// A rotor between motor and spring, against other ways to integrate it, and its energy.
#include "hal/actuators/series_elastic.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tests/support/allocation_guard.h"
#include "tests/unit/hal/actuator_test_support.h"

namespace footfall::tests {
namespace {

using hal::SeriesElasticActuator;
using hal::SeriesElasticParameters;
using hal::SeriesElasticState;
using hal::SeriesElasticStep;

SeriesElasticParameters random_parameters(std::mt19937_64& random, bool coulomb) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  return {.spring = 200.0 + 400.0 * part(random),
          .rotor = 0.05 + 0.1 * part(random),
          .viscous = 2.0 * part(random),
          .coulomb = coulomb ? 2.0 * part(random) : 0.0};
}

// Runge-Kutta of fourth order in `parts` of the step, without Coulomb friction.
SeriesElasticState runge_kutta(const SeriesElasticParameters& p, SeriesElasticState x, double u,
                               double v, double step, int parts) {
  const auto rate = [&](const SeriesElasticState& s) {
    return SeriesElasticState{s.rate - v,
                              (u - p.viscous * s.rate - p.spring * s.deflection) / p.rotor};
  };
  const double h = step / parts;
  const auto plus = [](const SeriesElasticState& s, const SeriesElasticState& d, double t) {
    return SeriesElasticState{s.deflection + t * d.deflection, s.rate + t * d.rate};
  };
  for (int k = 0; k < parts; ++k) {
    const auto a = rate(x), b = rate(plus(x, a, h / 2)), c = rate(plus(x, b, h / 2)),
               d = rate(plus(x, c, h));
    x.deflection += h / 6 * (a.deflection + 2 * b.deflection + 2 * c.deflection + d.deflection);
    x.rate += h / 6 * (a.rate + 2 * b.rate + 2 * c.rate + d.rate);
  }
  return x;
}

// The error of Runge-Kutta in 50 parts of 83 us at 75 rad/s is below (75 * 1.7e-6)^5.
TEST(SeriesElastic, AStepIsThatOfAFineIntegration) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 200; ++trial) {
    const SeriesElasticParameters p = random_parameters(random, false);
    SeriesElasticActuator actuator(p, kLoopStep);
    actuator.set_state({0.1 * normal(random), 5.0 * normal(random)});
    const double u = 20.0 * normal(random), v = 3.0 * normal(random);
    const auto expected = runge_kutta(p, actuator.state(), u, v, kLoopStep, 50);
    actuator.advance(u, v);
    EXPECT_NEAR(actuator.state().deflection, expected.deflection, 1e-13);
    EXPECT_NEAR(actuator.state().rate, expected.rate, 1e-11);
  }
}

// Power in: u θ' − f θ' from the motor, τ_s q' into the joint, b θ'^2 lost. The loss is the only
// part that advance() does not give: Simpson's rule over a step of a motion of 75 rad/s is wrong by
// less than 1e-7 of it.
double balance(const SeriesElasticParameters& p, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  SeriesElasticActuator actuator(p, kLoopStep);
  SeriesElasticActuator half(p, kLoopStep / 2);
  actuator.set_state({0.05 * normal(random), 3.0 * normal(random)});
  const double begin = actuator.energy();
  double in = 0.0, out = 0.0, lost = 0.0, turned_over = std::abs(begin);
  double u = 0.0, v = 0.0;
  for (int k = 0; k < 400; ++k) {
    if (k % 8 == 0) u = 15.0 * normal(random), v = 2.0 * normal(random);
    half.set_state(actuator.state());
    const double first = actuator.state().rate;
    const SeriesElasticStep done = actuator.advance(u, v);
    SeriesElasticParameters frictionless = p;
    frictionless.coulomb = 0.0;
    SeriesElasticActuator middle(frictionless, kLoopStep / 2);
    middle.set_state(half.state());
    middle.advance(done.motor_torque - done.friction_torque, v);
    const double mid = middle.state().rate, last = actuator.state().rate;
    in += (done.motor_torque - done.friction_torque) * done.motor_angle;
    out += done.spring_torque * v * kLoopStep;
    lost += p.viscous * kLoopStep / 6.0 * (first * first + 4.0 * mid * mid + last * last);
    turned_over += std::abs(done.motor_torque * done.motor_angle) +
                   std::abs(done.spring_torque * v * kLoopStep);
  }
  return std::abs(actuator.energy() - begin - in + out + lost) / turned_over;
}

TEST(SeriesElastic, EnergyIsBalancedOverRandomTrajectories) {
  std::mt19937_64 random(2);
  double worst = 0.0;
  for (int trial = 0; trial < 10000; ++trial) {
    worst = std::max(worst, balance(random_parameters(random, trial % 2 == 0), random));
  }
  EXPECT_LT(worst, 1e-3);
  RecordProperty("worst_ppb", std::to_string(1e9 * worst));
}

TEST(SeriesElastic, TheMeanSpringTorqueIsTheImpulseOnTheJoint) {
  SeriesElasticActuator whole(kKnee, 0.01), fine(kKnee, 1e-5);
  whole.set_state({0.02, 1.0});
  fine.set_state({0.02, 1.0});
  double impulse = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double before = fine.spring_torque();
    fine.advance(10.0, 0.5);
    impulse += 0.5e-5 * (before + fine.spring_torque());  // trapezoids: (75 * 1e-5)^2/12 of it
  }
  EXPECT_NEAR(whole.advance(10.0, 0.5).spring_torque * 0.01, impulse, 1e-6 * std::abs(impulse));
}

TEST(SeriesElastic, CoulombFrictionHoldsTheRotorUpToItsLimit) {
  SeriesElasticParameters p = kKnee;
  p.coulomb = 1.0;
  SeriesElasticActuator actuator(p, kLoopStep);
  for (int k = 0; k < 1000; ++k) actuator.advance(0.9, 0.0);
  EXPECT_NEAR(actuator.state().deflection, 0.0, 1e-15);
  for (int k = 0; k < 200000; ++k) actuator.advance(5.0, 0.0);
  // It comes to rest where motor and spring differ by no more than the friction.
  EXPECT_NEAR(actuator.state().rate, 0.0, 1e-9);
  EXPECT_NEAR(actuator.spring_torque(), 5.0, 1.0 + 1e-9);
}

// A constant torque below the limit, and a joint that moves: the spring's torque stays within the
// limit of the rotor's friction, which holds it in every step and does not let it creep.
TEST(SeriesElastic, CoulombFrictionHoldsTheRotorWhileTheJointMoves) {
  SeriesElasticActuator actuator({.spring = 415.0, .rotor = 0.0872756, .coulomb = 5.0}, kLoopStep);
  double turned = 0.0;
  for (int k = 0; k < 120000; ++k) {
    const double swing = 2.0 * std::numbers::pi * 3.0;  // 3 Hz, 1 mrad: 0.4 N m
    const double rate = 1e-3 * swing * std::cos(swing * k * kLoopStep);
    const SeriesElasticStep done = actuator.advance(0.8, rate);
    turned += done.motor_angle;
    ASSERT_NEAR(done.friction_torque, 0.8 - done.spring_torque, 0.01) << k;
  }
  EXPECT_LT(std::abs(turned), 1e-6);
}

TEST(SeriesElastic, CoulombFrictionTakesEnergyInEveryStep) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 1000; ++trial) {
    SeriesElasticParameters p = random_parameters(random, true);
    p.viscous = 0.0;
    SeriesElasticActuator actuator(p, kLoopStep);
    actuator.set_state({0.02 * normal(random), 2.0 * normal(random)});
    for (int k = 0; k < 50; ++k) {
      const double before = actuator.energy();
      actuator.advance(0.0, 0.0);
      EXPECT_LE(actuator.energy(), before * (1.0 + 1e-12));
    }
  }
}

// Springs 1e6 times stiffer and rotors 1e6 times lighter than Hume's: the rotor then follows.
TEST(SeriesElastic, NoSpringIsTooStiffAndNoRotorTooLight) {
  for (const auto& p : {SeriesElasticParameters{.spring = 4e8, .rotor = 0.1, .viscous = 0.5},
                        SeriesElasticParameters{.spring = 400.0, .rotor = 1e-7, .viscous = 0.5},
                        SeriesElasticParameters{.spring = 4e8, .rotor = 1e-7, .viscous = 1e3}}) {
    SeriesElasticActuator actuator(p, kLoopStep);
    actuator.set_state({1e-3, 1.0});
    double most = actuator.energy();
    for (int k = 0; k < 12000; ++k) {
      actuator.advance(0.0, 0.0);
      EXPECT_LE(actuator.energy(), most * (1.0 + 1e-9));
      most = actuator.energy();
    }
  }
}

TEST(SeriesElastic, TheMotorIsLimitedInTorqueAndSpeed) {
  SeriesElasticParameters p = kKnee;
  p.torque = 100.0;
  p.speed = 10.0;
  SeriesElasticActuator actuator(p, kLoopStep);
  EXPECT_EQ(actuator.advance(300.0, 0.0).motor_torque, 100.0);
  EXPECT_EQ(actuator.advance(-300.0, 0.0).motor_torque, -100.0);
  actuator.set_state({0.0, 9.0});
  EXPECT_NEAR(actuator.saturated(300.0), 50.0, 1e-12);  // half way from 8 to 10 rad/s
  EXPECT_EQ(actuator.saturated(-300.0), -100.0);        // brakes with all it has
  actuator.set_state({0.0, 11.0});
  EXPECT_EQ(actuator.saturated(300.0), 0.0);
}

// u to τ_s with the output locked: k / (J s^2 + b s + k), its resonance at 11 Hz. The input is held
// over a step of 83 us, which turns the phase by half a step: 1.5 deg at 50 Hz.
TEST(SeriesElastic, ALockedOutputRespondsAsItsTransferFunction) {
  const std::complex<double> i(0.0, 1.0);
  for (const double hertz : {1.0, 5.0, 11.0, 20.0, 50.0}) {
    const double w = 2.0 * std::numbers::pi * hertz;
    SeriesElasticActuator actuator(kKnee, kLoopStep);
    const int period = static_cast<int>(std::lround(1.0 / (hertz * kLoopStep)));
    const double w_exact = 2.0 * std::numbers::pi / (period * kLoopStep);
    std::complex<double> sum;
    const int settle = static_cast<int>(4.0 / kLoopStep) / period;  // decay b/2J: 2.9 1/s
    for (int k = 0; k < (settle + 1) * period; ++k) {
      const double t = k * kLoopStep;
      if (k >= settle * period) {
        sum += actuator.spring_torque() * std::exp(-i * w_exact * t) * (2.0 / period);
      }
      actuator.advance(std::cos(w_exact * t), 0.0);
    }
    const std::complex<double> s = i * w_exact;
    const std::complex<double> held = (1.0 - std::exp(-s * kLoopStep)) / (s * kLoopStep);
    const std::complex<double> expected =
        held * kKnee.spring / (kKnee.rotor * s * s + kKnee.viscous * s + kKnee.spring);
    EXPECT_NEAR(std::abs(sum / expected), 1.0, 0.02) << w / (2.0 * std::numbers::pi) << " Hz";
    EXPECT_NEAR(std::arg(sum / expected), 0.0, 0.035);
  }
}

TEST(SeriesElastic, ImpossibleParametersAreRefused) {
  const auto refused = [](SeriesElasticParameters p, double step = kLoopStep) {
    EXPECT_THROW(SeriesElasticActuator(p, step), std::invalid_argument);
  };
  refused({.spring = 0.0, .rotor = 0.1});
  refused({.spring = 400.0, .rotor = 0.0});
  refused({.spring = 400.0, .rotor = 0.1, .viscous = -1.0});
  refused({.spring = 400.0, .rotor = 0.1, .coulomb = -1.0});
  refused({.spring = std::nan(""), .rotor = 0.1});
  refused({.spring = 400.0, .rotor = 0.1}, 0.0);
}

TEST(SeriesElastic, AStepAllocatesNothing) {
  SeriesElasticActuator actuator(kKnee, kLoopStep);
  const AllocationGuard guard;
  for (int k = 0; k < 100; ++k) actuator.advance(1.0, 0.1);
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
