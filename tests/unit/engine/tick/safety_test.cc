// The last word before the hardware.
#include "engine/tick/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

using core::Fault;

class Safety : public testing::Test {
 protected:
  model::RobotDescription robot = load_hume();
  engine::SafetyFilter filter{robot};
};

TEST_F(Safety, OneTorqueThatIsNotFiniteMakesAllZeroAndIsReported) {
  hal::Commands commands;
  commands.tau = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity(), 1.0};
  const engine::FaultFindings findings = filter.filter(commands, hal::Sensors{});
  EXPECT_TRUE(findings.has(Fault::non_finite));
  EXPECT_FALSE(findings.has(Fault::torque_limit));
  EXPECT_EQ(commands.tau[0], 0.0);
  EXPECT_EQ(commands.tau[1], 0.0);
  EXPECT_EQ(commands.tau[2], 0.0);
  EXPECT_EQ(commands.tau[3], 0.0);
}

TEST_F(Safety, TorquesAreClampedToEachJointsOwnLimit) {
  hal::Commands commands;
  commands.tau = {70.0, 70.0, -170.0, -70.0, 0.0, 99.9};
  const engine::FaultFindings findings = filter.filter(commands, hal::Sensors{});
  EXPECT_TRUE(findings.has(Fault::torque_limit));
  const engine::FaultPlace& worst = findings.place(Fault::torque_limit);
  EXPECT_EQ(worst.joint, 2);  // asked for 70 Nm too much, the others for 20
  EXPECT_EQ(worst.value, -170.0);
  EXPECT_EQ(worst.excess, 70.0);
  const std::array<double, 6> wanted = {50.0, 70.0, -100.0, -50.0, 0.0, 99.9};
  for (std::size_t j = 0; j < 6; ++j) EXPECT_EQ(commands.tau[j], wanted[j]) << j;
}

// Torque loops that deliver 40 % of what they are told: the limit holds for what they deliver.
TEST_F(Safety, ALimitOfMeasuredTorquesLetsCommandsGoBeyondUntilItIsReached) {
  robot.command_limit = 2.5;
  hal::Commands commands;
  hal::Sensors sensors;
  sensors.tau[0] = 40.0;
  commands.tau[0] = 100.0;
  EXPECT_FALSE(filter.filter(commands, sensors).has(Fault::torque_limit));
  EXPECT_EQ(commands.tau[0], 100.0);
  commands.tau[0] = 130.0;
  EXPECT_TRUE(filter.filter(commands, sensors).has(Fault::torque_limit));
  EXPECT_EQ(commands.tau[0], 125.0);
  sensors.tau[0] = 50.0;
  commands.tau[0] = 125.0;
  EXPECT_TRUE(filter.filter(commands, sensors).has(Fault::torque_limit));
  EXPECT_EQ(commands.tau[0], 50.0);
  sensors.tau[0] = -50.0;  // the other way: free to come back
  commands.tau[0] = 100.0;
  filter.filter(commands, sensors);
  EXPECT_EQ(commands.tau[0], 100.0);
  sensors.tau[0] = std::numeric_limits<double>::quiet_NaN();
  filter.filter(commands, sensors);
  EXPECT_EQ(commands.tau[0], 50.0);
}

TEST_F(Safety, TheFirstTickHasNoStepAndLaterOnesAreOfWhatIsSent) {
  hal::Commands commands;
  commands.tau[0] = 40.0;
  EXPECT_FALSE(filter.filter(commands, hal::Sensors{}).any());
  EXPECT_EQ(filter.torque_step(), 0.0);
  commands.tau[0] = 44.9;
  EXPECT_FALSE(filter.filter(commands, hal::Sensors{}).has(Fault::torque_step));
  EXPECT_NEAR(filter.torque_step(), 4.9, 1e-12);
  commands.tau[0] = 500.0;  // clamped to 50: a step of 5.1
  EXPECT_TRUE(filter.filter(commands, hal::Sensors{}).has(Fault::torque_step));
  EXPECT_NEAR(filter.torque_step(), 5.1, 1e-12);
  commands.tau = {50.0, 6.0, -8.0};  // the largest of two steps, with its sign
  const engine::FaultPlace place =
      filter.filter(commands, hal::Sensors{}).place(Fault::torque_step);
  EXPECT_EQ(place.joint, 2);
  EXPECT_EQ(place.value, -8.0);
  filter.filter(commands, hal::Sensors{});
  commands.tau[0] = 50.0;
  EXPECT_FALSE(filter.filter(commands, hal::Sensors{}).has(Fault::torque_step));
  EXPECT_EQ(filter.torque_step(), 0.0);
}

// Binary fractions make the bound a step that rounding can overshoot.
TEST_F(Safety, LimitedStepsNeverExceedTheBoundByABitAndReachWhatIsAskedFor) {
  for (const double bound : {5.0, 0.1, 0.3, 1.0 / 3.0}) {
    robot.torque_step_limit = bound;
    engine::SafetyFilter limited{robot};
    hal::Commands sent;
    limited.filter(sent, hal::Sensors{}, true);
    std::array<double, 6> before{};
    for (const double wanted : {-33.3, 48.7, 0.0, 1e-9, 49.99}) {
      const double away = std::abs(wanted - before[0]);
      const auto ticks = static_cast<int>(std::ceil(away / bound * (1.0 + 1e-12)));
      for (int k = 1; k <= ticks; ++k) {
        for (std::size_t j = 0; j < 6; ++j) sent.tau[j] = wanted;
        const engine::FaultFindings findings = limited.filter(sent, hal::Sensors{}, true);
        EXPECT_FALSE(findings.has(Fault::torque_step));
        EXPECT_EQ(limited.held_back(), sent.tau[0] != wanted);
        for (std::size_t j = 0; j < 6; ++j) {
          EXPECT_LE(std::abs(sent.tau[j] - before[j]), bound);
          before[j] = sent.tau[j];
        }
      }
      EXPECT_EQ(sent.tau[0], wanted) << bound;  // as soon as that rate allows
    }
  }
}

TEST_F(Safety, WithoutABoundNothingIsHeldBackAndWhatIsNotFiniteIsLetGoAtOnce) {
  hal::Commands commands;
  commands.tau[0] = 40.0;
  filter.filter(commands, hal::Sensors{}, true);  // the first command has none before it
  EXPECT_EQ(commands.tau[0], 40.0);
  commands.tau[0] = std::nan("");
  filter.filter(commands, hal::Sensors{}, true);
  EXPECT_EQ(commands.tau[0], 0.0);
  robot.torque_step_limit = 0.0;
  commands.tau[0] = 45.0;
  filter.filter(commands, hal::Sensors{}, true);
  EXPECT_EQ(commands.tau[0], 45.0);
  EXPECT_FALSE(filter.held_back());
}

TEST_F(Safety, AStandingRobotIsInOrder) {
  model::ControlModel model(robot);
  model.update(standing_state(robot));
  EXPECT_FALSE(filter.check_state({}, {}, model).any());
}

TEST_F(Safety, HeightIsCountedFromTheLowestContactPoint) {
  model::ControlModel model(robot);
  model::State state = standing_state(robot);
  state.p_WB[2] += 10.0;  // on a roof
  model.update(state);
  EXPECT_FALSE(filter.check_state({}, {}, model).any());
  for (const std::size_t leg : {0U, 3U}) {
    state.q[leg + 1] = -1.4;
    state.q[leg + 2] = 2.8;
  }
  model.update(state);
  EXPECT_TRUE(filter.check_state({}, {}, model).has(Fault::fall));
}

TEST_F(Safety, AJointBeyondItsLimitIsReported) {
  model::ControlModel model(robot);
  model::State state = standing_state(robot);
  state.q[2] = robot.joints[2].position_max + 1e-6;
  model.update(state);
  const engine::FaultFindings findings = filter.check_state({}, {}, model);
  EXPECT_TRUE(findings.has(Fault::joint_limit));
  EXPECT_FALSE(findings.has(Fault::fall));
}

}  // namespace
}  // namespace footfall::tests
