// Actuators and delays found from synthetic excitations, without a simulator.
#include <gtest/gtest.h>

#include "lab/identify/windows.h"
#include "tests/unit/lab/identify_test_support.h"

namespace footfall::tests {
namespace {

using lab::Estimate;
using lab::Richness;

double relative(const Estimate& found, double truth) { return std::abs(found.value / truth - 1.0); }

lab::ActuatorEstimate identified(const Excitation& excitation) {
  return lab::identify_actuator(excite(excitation).record);
}

// Counts errors beyond three standard errors; some 1e-4 of the value are of the method.
struct Honesty {
  int within = 0, count = 0;
  void add(const Estimate& found, double truth) {
    ++count;
    if (std::abs(found.value - truth) < 3.0 * found.error + 1e-4 * truth) ++within;
  }
};

TEST(Identify, FindsRandomActuatorsAndTheirDelay) {
  std::mt19937 random(7);
  const auto draw = [&](double least, double most) {
    return std::uniform_real_distribution(least, most)(random);
  };
  Honesty honesty;
  for (unsigned k = 0; k < 20; ++k) {
    Excitation e;
    e.actuator = {.spring = draw(200, 800),
                  .rotor = draw(0.04, 0.2),
                  .viscous = draw(0.2, 2),
                  .coulomb = draw(0.3, 3)};
    e.nominal_spring = e.actuator.spring * draw(0.9, 1.1);
    e.command_delay = static_cast<int>(std::lround(draw(0, 2 * kLoopSteps)));
    e.measurement_delay = static_cast<int>(std::lround(draw(0, kLoopSteps)));
    e.time = 8.0;
    e.seed = 100 + k;
    Excited excited = excite(e);
    const lab::DelayEstimate delay = lab::identify_delay(excited.record, excited.loop);
    excited.record.moment = delay.moment;
    const lab::ActuatorEstimate found = lab::identify_actuator(excited.record);
    SCOPED_TRACE(k);
    ASSERT_EQ(found.richness, Richness::good);
    EXPECT_LT(relative(found.spring, e.actuator.spring), 0.002);
    EXPECT_LT(relative(found.rotor, e.actuator.rotor), 0.005);
    EXPECT_LT(relative(found.viscous, e.actuator.viscous), 0.01);
    EXPECT_LT(relative(found.coulomb, e.actuator.coulomb), 0.02);
    ASSERT_TRUE(delay.known);
    const double truth = (e.command_delay + e.measurement_delay) * kTickTime / kLoopSteps;
    EXPECT_NEAR(delay.delay.value, truth, 0.01 * kTickTime);
    honesty.add(found.spring, e.actuator.spring);
    honesty.add(found.rotor, e.actuator.rotor);
    honesty.add(found.viscous, e.actuator.viscous);
    honesty.add(found.coulomb, e.actuator.coulomb);
  }
  EXPECT_GE(honesty.within, honesty.count * 9 / 10);
}

TEST(Identify, NeedsNoLawForTheActuator) {
  const Excitation e;
  const lab::ActuatorEstimate found = identified(e);
  ASSERT_EQ(found.richness, Richness::good);
  EXPECT_LT(relative(found.spring, e.actuator.spring), 0.005);
  EXPECT_LT(relative(found.rotor, e.actuator.rotor), 0.01);
  EXPECT_LT(relative(found.viscous, e.actuator.viscous), 0.03);
  EXPECT_LT(relative(found.coulomb, e.actuator.coulomb), 0.01);
  EXPECT_NEAR(found.offset.value, 0.0, 0.005);
}

TEST(Identify, SaysWhatAnExcitationLacks) {
  Excitation e;
  e.amplitude = 0.0;
  EXPECT_EQ(identified(e).richness, Richness::still);
  e = {};
  e.time = 0.5;
  EXPECT_EQ(identified(e).richness, Richness::too_slow);
  e = {};
  e.one_sine = true;
  const lab::ActuatorEstimate found = identified(e);
  EXPECT_EQ(found.richness, Richness::poor);
  EXPECT_GT(found.condition, lab::kLargestCondition);
  EXPECT_EQ(lab::identify_actuator({}).richness, Richness::still);
}

TEST(Identify, FindsTheDelayOfACascade) {
  Excitation e;
  e.command_delay = 11;
  e.gains = hal::TorqueLoopGains{.type = hal::TorqueLoopGains::Type::cascade,
                                 .p = 0.8,
                                 .i = 2.0,
                                 .velocity_p = 25.0,
                                 .velocity_i = 50.0};
  const Excited excited = excite(e);
  const lab::DelayEstimate found = lab::identify_delay(excited.record, excited.loop);
  ASSERT_TRUE(found.known) << found.explained;
  EXPECT_NEAR(found.delay.value, 11 * kTickTime / kLoopSteps, 0.02 * kTickTime);
}

TEST(Identify, DoesNotBelieveAWrongLaw) {
  Excited excited = excite({});
  hal::TorqueLoopGains half = excited.loop.gains;
  half.damping *= 0.5;
  for (const auto& gains : {half, hal::TorqueLoopGains{.velocity_p = 25.0}}) {
    excited.loop.gains = gains;
    const lab::DelayEstimate found = lab::identify_delay(excited.record, excited.loop);
    EXPECT_FALSE(found.known);
    EXPECT_TRUE(found.moment.empty());
  }
  EXPECT_FALSE(lab::identify_delay({}, {}).known);
}

TEST(IdentifyWindows, ModulatingFunctionsVanishWithTheirDerivativesAtBothEnds) {
  for (const bool odd : {false, true}) {
    for (const double x : {0.0, 1.0, -0.1, 1.1}) {
      const lab::Modulation end = lab::modulation(x, odd);
      EXPECT_EQ(end.value, 0.0);
      EXPECT_EQ(end.first, 0.0);
      EXPECT_EQ(end.second, 0.0);
    }
    for (const double x : {0.1, 0.37, 0.5, 0.81}) {
      const double h = 1e-5;
      const lab::Modulation before = lab::modulation(x - h, odd),
                            after = lab::modulation(x + h, odd);
      const lab::Modulation here = lab::modulation(x, odd);
      EXPECT_NEAR(here.first, (after.value - before.value) / (2 * h), 1e-6);
      EXPECT_NEAR(here.second, (after.first - before.first) / (2 * h), 1e-6);
    }
  }
}

TEST(IdentifyWindows, CoverAnInterval) {
  for (const int length : {5, 60, 61, 90, 119, 120, 500}) {
    const std::vector<lab::Interval> windows = lab::windows_of({10, 9 + length, 1}, 60);
    EXPECT_EQ(windows.front().first, 10);
    EXPECT_EQ(windows.back().last, 9 + length);
    for (std::size_t k = 0; k < windows.size(); ++k) {
      EXPECT_EQ(windows[k].length(), std::min(length, 60));
      if (k > 0) EXPECT_LE(windows[k].first, windows[k - 1].first + 30);
    }
  }
}

TEST(IdentifyWindows, IntervalsEndBeforeReversalsAndRest) {
  std::vector<double> angle;
  for (int k = 0; k < 100; ++k) angle.push_back(0.01 * k);
  for (int k = 0; k < 50; ++k) angle.push_back(1.0);
  for (int k = 0; k < 100; ++k) angle.push_back(1.0 - 0.01 * k);
  const auto intervals = lab::moving_intervals(angle, kTickTime);
  ASSERT_EQ(intervals.size(), 2U);
  EXPECT_EQ(intervals[0].direction, 1);
  EXPECT_LE(intervals[0].last, 100);
  EXPECT_GT(intervals[0].last, 90);
  EXPECT_EQ(intervals[1].direction, -1);
  EXPECT_GE(intervals[1].first, 150);
  EXPECT_TRUE(lab::moving_intervals(std::vector(100, 0.5), kTickTime).empty());
}

TEST(IdentifyWindows, EncoderStepIsTheSmallestChange) {
  EXPECT_EQ(lab::encoder_step(std::vector{1.0, 1.0, 1.5, 3.0, 2.75}), 0.25);
  EXPECT_EQ(lab::encoder_step(std::vector{1.0, 1.0}), 0.0);
}

}  // namespace
}  // namespace footfall::tests
