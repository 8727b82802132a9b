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
constexpr behaviors::PhysicsWorld kElastic{.command_delay = kTickPeriod, .series_elastic = true};

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
