// Passivity: the closed form against a sweep, and against energy in a simulation.
#include "hal/actuators/passivity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/hal/actuator_test_support.h"

namespace footfall::tests {
namespace {

using hal::SeriesElasticParameters;
using hal::TorqueLoopGains;

class RandomLoops {
 public:
  explicit RandomLoops(std::uint64_t seed) : random_(seed) {}
  double log_uniform(double from, double to) {
    std::uniform_real_distribution<double> part(std::log(from), std::log(to));
    return std::exp(part(random_));
  }
  SeriesElasticParameters actuator(bool viscous) {
    return {.spring = log_uniform(100.0, 1000.0),
            .rotor = log_uniform(0.03, 0.3),
            .viscous = viscous ? log_uniform(0.01, 5.0) : 0.0};
  }
  TorqueLoopGains cascade() {
    return {.type = TorqueLoopGains::Type::cascade,
            .p = log_uniform(0.01, 10.0),
            .i = log_uniform(0.1, 1000.0),
            .velocity_p = log_uniform(0.5, 50.0),
            .velocity_i = log_uniform(1.0, 10000.0)};
  }
  TorqueLoopGains direct() {
    return {.type = TorqueLoopGains::Type::direct,
            .p = log_uniform(0.5, 50.0),
            .i = log_uniform(1.0, 3000.0),
            .forward = 1.0,
            .damping = log_uniform(0.5, 20.0)};
  }

 private:
  std::mt19937_64 random_;
};

// Re a is c0 + c2/w^2: the sweep's ends, where one of the two is all, are far beyond both corners.
TEST(Passivity, TheClosedFormAgreesWithASweepOfTheFrequency) {
  RandomLoops loops(5);
  int judged = 0, passive = 0, disagreed = 0;
  while (judged < 1250) {
    const auto actuator = loops.actuator(judged % 2 == 0);
    // 1000 cascades, and 250 direct loops between them.
    const auto gains = judged % 5 < 4 ? loops.cascade() : loops.direct();
    const double margin = hal::passivity_margin(gains, actuator);
    if (std::abs(margin) < 0.01) continue;  // at equality
    ++judged;
    passive += margin > 0.0;
    const double least = hal::least_admittance(gains, actuator, 0.0, 1e-5, 1e7, 2000);
    EXPECT_EQ(margin > 0.0, least > 0.0) << "margin " << margin << ", Re a " << least;
    disagreed += (margin > 0.0) != (least > 0.0);
  }
  RecordProperty("judged", judged);
  RecordProperty("disagreed", disagreed);
  EXPECT_GT(passive, 250);
  EXPECT_LT(passive, 1000);
}

TEST(Passivity, ProportionalLoopsArePassiveWithoutDelayAndNotWithIt) {
  const SeriesElasticParameters knee{.spring = 415.0, .rotor = 0.0872756};
  const TorqueLoopGains p{.type = TorqueLoopGains::Type::cascade, .p = 2.0, .velocity_p = 15.0};
  EXPECT_GT(hal::passivity_margin(p, knee), 0.0);
  EXPECT_GT(hal::least_admittance(p, knee, 0.0, 0.01, 1e4, 1000), 0.0);
  EXPECT_LT(hal::least_admittance(p, knee, 0.667e-3, 0.01, 1e4, 1000), 0.0);
}

// The output is moved as a sine, from rest: the most energy that came out of the port until any
// moment, ∫τ_s q' dt, relative to what went to and fro. A passive port has none to give. The loop
// runs at 120 kHz, whose delay of half a step turns 8 Hz by 0.012 deg.
double most_energy_given(const TorqueLoopGains& gains, const SeriesElasticParameters& actuator) {
  constexpr double kHertz = 8.0, kFine = 1.0 / 120000.0;
  hal::SeriesElasticActuator motor(actuator, kFine);
  hal::TorqueLoop loop(gains, kFine);
  double energy = 0.0, most = 0.0, turned_over = 0.0;
  for (int k = 0; k < 20.0 / kFine && turned_over < 1e12; ++k) {
    const double rate = std::cos(2.0 * M_PI * kHertz * (k + 0.5) * kFine);
    const auto done =
        motor.advance(one_step(loop, {0.0, motor.spring_torque(), motor.state().rate, rate}), rate);
    energy += done.spring_torque * rate * kFine;
    turned_over += std::abs(done.spring_torque * rate * kFine);
    most = std::max(most, energy);
  }
  return most / turned_over;
}

TEST(Passivity, OnlyWhatIsNotPassiveGivesEnergyToAMovingOutput) {
  RandomLoops loops(6);
  int judged = 0, agreed = 0;
  while (judged < 50) {
    const auto actuator = loops.actuator(true);
    const auto gains = loops.direct();
    const double margin = hal::passivity_margin(gains, actuator);
    if (std::abs(margin) < 0.2) continue;  // Re a has the same sign at all frequencies
    ++judged;
    agreed += (most_energy_given(gains, actuator) > 1e-3) == (margin < 0.0);
  }
  EXPECT_GE(agreed, 48);
  RecordProperty("agreed", agreed);
}

}  // namespace
}  // namespace footfall::tests
