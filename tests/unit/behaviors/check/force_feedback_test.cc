// What feedback of a measured internal force bears: the limit, and what `check` says of it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "tests/unit/behaviors/check/physics_test_support.h"

namespace footfall::tests {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr double kTickPeriod = 1.0 / 1500.0;  // s

std::string fed_back(const std::string& feedback, const std::string& parameters = "") {
  return standing(
      "[right_foot, left_foot]", dual_tasks(),
      "    internal: {t: {between: [right_foot, left_foot], reference: 20 N, feedback: " +
          feedback + "}}\n" + parameters);
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
}

// A period of delay.
const behaviors::PhysicsWorld kElastic{.command_delay = kTickPeriod, .series_elastic = true};

TEST(PhysicsFeedback, SeriesElasticActuatorsBearLess) {
  EXPECT_EQ(judged_in(fed_back("2"), kElastic), "");
  EXPECT_THAT(judged_in(fed_back("3"), kElastic),
              HasSubstr("warning: internal force 't' is fed back with 3, more than half of what is "
                        "stable: the measured force is that of the series-elastic actuators, 0.75 "
                        "ms late beside their own lag, through a low-pass of 20 Hz; from 4."));
  EXPECT_THAT(judged_in(fed_back("5"), kElastic),
              HasSubstr("error: internal force 't' is unstable with feedback 5"));
}

TEST(PhysicsFeedback, TheTorqueLoopsInForceCount) {
  const std::string soft =
      "    torque_loop: {right_foot: soft, left_foot: soft}\n"
      "torque_loop: {soft: {type: direct, p: 0.8, forward: 0, damps: spring, d: 12 Nm s/rad}}\n";
  EXPECT_EQ(judged_in(fed_back("3.5", soft), kElastic), "");
  EXPECT_THAT(judged_in(fed_back("7", soft), kElastic),
              HasSubstr("warning: internal force 't' is fed back with 7"));
  EXPECT_THAT(judged_in(fed_back("11", soft), kElastic), HasSubstr("is unstable with feedback 11"));
}

TEST(PhysicsFeedback, BothDelaysAndTheRotorsFrictionCount) {
  behaviors::PhysicsWorld late = kElastic;
  late.measurement_delay = 2.0 * kTickPeriod;
  EXPECT_THAT(judged_in(fed_back("4"), late), HasSubstr("2.08 ms late beside their own lag"));
  EXPECT_THAT(judged_in(fed_back("4"), late), HasSubstr("is unstable with feedback 4"));
  behaviors::PhysicsWorld damped = kElastic;
  damped.viscous = 30.0;
  EXPECT_THAT(judged_in(fed_back("5"), damped), Not(HasSubstr("unstable with feedback 5")));
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

// Four feet on level ground bear five tensions and their warp; `all` asks for no more than there
// is.
TEST(PhysicsInternal, SixTensionsByNameAreOneTooMany) {
  const std::string feet[] = {"front_right_foot", "front_left_foot", "rear_left_foot",
                              "rear_right_foot"};
  const auto text = [&](const std::string& forces) {
    return "behavior: 1\nrobot: quadruped\nmachine:\n  contacts: [front_right_foot, "
           "front_left_foot, "
           "rear_right_foot, rear_left_foot]\n  tasks:\n    com: {type: com_position, reference: "
           "entry, gains: {kp: 100, kd: 20}}\n    turn: {type: body_orientation, reference: 0, "
           "gains: "
           "{kp: 100, kd: 20}}\n  internal:\n" +
           forces;
  };
  std::string six;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      six += "    t" + std::to_string(i) + std::to_string(j) + ": {between: [" + feet[i] + ", " +
             feet[j] + "], reference: 1 N}\n";
    }
  }
  EXPECT_THAT(physics(text(six)),
              HasSubstr("error: 6 internal forces, but the feet in contact bear only 5"));
  EXPECT_EQ(physics(text("    t: {between: all, reference: 1 N}\n")), "");
  std::string warp = six.substr(six.find("    t01"), six.rfind("    t23"));
  warp +=
      "    w: {between: [front_right_foot, front_left_foot, rear_left_foot, rear_right_foot], "
      "reference: 1 N}\n";
  EXPECT_EQ(physics(text(warp)), "");
}

}  // namespace
}  // namespace footfall::tests
