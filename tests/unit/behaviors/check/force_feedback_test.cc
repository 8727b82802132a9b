// What feedback of a measured internal force bears: the limit, and what `check` says of it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>

#include "behaviors/check/physics/sampled_loop.h"
#include "tests/support/hume.h"
#include "tests/unit/behaviors/check/physics_test_support.h"

namespace footfall::tests {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr double kTickPeriod = 1.0 / 1500.0;  // s

std::string fed_back(const std::string& feedback, const std::string& parameters = "") {
  return standing(
      "[right_foot, left_foot]", dual_tasks(),
      "    internal: {t: {between: [right_foot, left_foot], reference: 20 N, feedback: " +
          feedback + "}}\n" + parameters);
}

// An error of a force that is commanded `periods` periods before it is measured, stepped by hand:
// y the low-pass of what was commanded then, F = -K y.
bool dies_out(double gain, double bandwidth, int periods) {
  const double a =
      bandwidth > 0.0 ? std::exp(-2.0 * std::numbers::pi * bandwidth * kTickPeriod) : 0.0;
  std::deque<double> commanded(static_cast<std::size_t>(periods), 1.0);
  double y = 1.0, late = 0.0;
  for (int k = 0; k < 60000; ++k) {
    y = a * y + (1.0 - a) * commanded.front();
    commanded.pop_front();
    commanded.push_back(-gain * y);
    if (k >= 59900) late = std::max(late, std::abs(y));
    if (std::abs(y) > 1e6) return false;
  }
  return late < 1e-3;
}

// 1500 Hz; of the characteristic polynomial z^n - a z^(n-1) + K (1 - a).
TEST(PhysicsFeedback, TheLimitIsWhereAnErrorNoLongerDiesOut) {
  const struct {
    double bandwidth;
    std::array<double, 4> limits;  // n = 1, 2, 3, 4, as solved beforehand, two digits
  } rows[] = {{20.0, {23.9, 12.4, 8.0, 5.9}},
              {40.0, {12.0, 6.5, 4.3, 3.3}},
              {80.0, {6.0, 3.5, 2.5, 2.0}},
              {0.0, {1.0, 1.0, 1.0, 1.0}}};
  for (const auto& row : rows) {
    for (int n = 1; n <= 4; ++n) {
      const double limit = behaviors::force_feedback_limit(row.bandwidth, kTickPeriod, n);
      EXPECT_NEAR(limit, row.limits[static_cast<std::size_t>(n) - 1], 0.051) << row.bandwidth;
      EXPECT_TRUE(dies_out(0.995 * limit, row.bandwidth, n)) << row.bandwidth << ' ' << n;
      EXPECT_FALSE(dies_out(1.005 * limit, row.bandwidth, n)) << row.bandwidth << ' ' << n;
    }
  }
}

TEST(PhysicsFeedback, BeyondTheLimitItIsRefusedAndAboveHalfOfItWarnedAbout) {
  EXPECT_EQ(physics(fed_back("11.9")), "");
  EXPECT_THAT(physics(fed_back("12.1")),
              HasSubstr("warning: internal force 't' is fed back with 12.1, more than half of what "
                        "is stable: the measured force is that of a command 0.667 ms before, "
                        "through a low-pass of 20 Hz; from 23.9 on an error grows"));
  const std::string text = fed_back("24");
  EXPECT_THAT(physics(text),
              StartsWith(place_of(text, "20 N") +
                         "error: internal force 't' is unstable with feedback 24: the measured "
                         "force is that of a command 0.667 ms before, through a low-pass of 20 Hz; "
                         "below 23.9 an error dies out"));
  EXPECT_THAT(physics(fed_back("1.5, bandwidth: 0 Hz")), HasSubstr("below 1 an error dies out"));
  EXPECT_EQ(judged_in(fed_back("0.9"), {.series_elastic = true}), "");
  EXPECT_EQ(judged_in(fed_back("1.5"), {.series_elastic = true}), "");
  EXPECT_THAT(judged_in(fed_back("12"), {.series_elastic = true}),
              HasSubstr("error: internal force 't' is unstable with feedback 12: "));
}

TEST(PhysicsFeedback, TheEndsOfALiveRangeAreWarnedAbout) {
  const std::string live = "parameters: {k: {value: 0.5, range: [0, 30], live: true}}\n";
  EXPECT_THAT(
      physics(fed_back("$k", live)),
      HasSubstr("warning: internal force 't' is unstable with feedback 30 at the end of the "
                "range of 'k'"));
  EXPECT_EQ(physics(fed_back("$k", "parameters: {k: {value: 0.5, range: [0, 0.9], live: true}}\n")),
            "");
}

TEST(PhysicsFeedback, ARangeThatReachesMinusOneIsWarnedAbout) {
  EXPECT_THAT(
      physics(fed_back("$k", "parameters: {k: {value: 0.5, range: [-2, 1], live: true}}\n")),
      HasSubstr("is unstable with feedback -2 at the end of the range of 'k'"));
  EXPECT_FALSE(dies_out(-1.01, 20.0, 1));
  EXPECT_TRUE(dies_out(-0.9, 20.0, 1));
}

// Commands in a line of physics steps, as the simulator keeps them: how old is the one that acted
// in the last step before a tick?
TEST(PhysicsFeedback, TheAgeOfTheMeasuredTorqueIsThatOfItsCommand) {
  for (const int steps : {1, 2, 3}) {
    for (int late = 0; late < 8; ++late) {
      std::deque<int> line(static_cast<std::size_t>(late), 0);
      int acted = 0;
      for (int tick = 0; tick < 20; ++tick) {
        for (int s = 0; s < steps; ++s) {
          line.push_back(tick);
          acted = line.front();
          line.pop_front();
        }
      }
      const int periods = 20 - acted;
      EXPECT_THAT(
          judged_in(fed_back("30"),
                    {.steps_per_tick = steps, .command_delay = late * kTickPeriod / steps}),
          HasSubstr(fmt::format("that of a command {:.3g} ms before", 1e3 * periods * kTickPeriod)))
          << steps << ' ' << late;
    }
  }
}

// Simulated in time: whether an error of the force of a joint at rest grows. The rotor, its direct
// torque loop and the spring with small steps; low-pass and feedback once a period.
bool grows(const model::JointDescription& joint, const hal::TorqueLoopGains& gains, double feedback,
           double bandwidth, double period) {
  constexpr int kSteps = 200;  // a period
  const double h = period / kSteps, a = std::exp(-2.0 * M_PI * bandwidth * period);
  double angle = 0.1, rate = 0.0, filtered = 0.0, early = 0.0, late = 0.0;
  for (int tick = 0; tick < 4000; ++tick) {
    filtered = a * filtered + (1.0 - a) * joint.spring * angle;
    const double command = -feedback * filtered;
    for (int k = 0; k < kSteps; ++k) {
      const double torque = joint.spring * angle;
      const double motor =
          gains.forward * command + gains.p * (command - torque) - gains.damping * rate;
      rate += h * (motor - torque) / joint.rotor;
      angle += h * rate;
    }
    (tick < 2000 ? early : late) = std::max(tick < 2000 ? early : late, std::abs(angle));
    if (tick == 200) early = 0.0;
    if (!(std::abs(angle) < 1e6)) return true;
  }
  return late > early;
}

// The bound of the check counts a period and a half of delay; here there is half of one, and the
// low-pass' own: so the bound is safe, and no more than twice too careful.
TEST(PhysicsFeedback, TheBoundOfSeriesElasticActuatorsIsSafeAndNotFarFromTheTruth) {
  const std::string said = judged_in(fed_back("50"), {.series_elastic = true});
  const std::size_t at = said.find("actuator; below ");
  ASSERT_NE(at, std::string::npos) << said;
  const double bound = std::stod(said.substr(at + std::string("actuator; below ").size()));
  const model::RobotDescription robot = load_hume();
  bool any = false;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const auto& gains = robot.drives.torque_loop[j];
    EXPECT_FALSE(grows(robot.joints[j], gains, 0.98 * bound, 20.0, robot.period_s()));
    any = any || grows(robot.joints[j], gains, 2.0 * bound, 20.0, robot.period_s());
  }
  EXPECT_TRUE(any);
}

}  // namespace
}  // namespace footfall::tests
