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
  EXPECT_THAT(judged_in(fed_back("1.5"), {.series_elastic = true}),
              HasSubstr("and of a series-elastic actuator; below 1 an error dies out"));
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

}  // namespace
}  // namespace footfall::tests
