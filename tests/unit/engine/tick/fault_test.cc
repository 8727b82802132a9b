// What the loop does when something is wrong: each fault is counted once when it appears, and what
// is written to the hardware stays finite.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>

#include "tests/support/fake_robot.h"

namespace footfall::tests {
namespace {

using core::Fault;
using engine::LoopState;

// Holds the posture so stiffly that 1 rad of error is far beyond every torque limit.
constexpr const char* kHold = R"(
behavior: 1
robot: hume
machine:
  safe: limp
  states:
    hold: {contacts: [], tasks: {pose: {type: joint_posture, priority: 1, gains: {kp: 2000}, reference: entry}}}
    limp: {contacts: [], tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}}
)";

constexpr double kHeavy = 1e6;  // kg m^2: joints that do not move

bool finite(const hal::Commands& commands) {
  for (const double tau : commands.tau) {
    if (!std::isfinite(tau)) return false;
  }
  return true;
}

void run(StubRig& rig, int ticks) {
  for (int k = 0; k < ticks; ++k) {
    rig.loop->tick();
    ASSERT_TRUE(finite(rig.loop->commands())) << k;
  }
}

// Rows that leave their level by their weight take their rank along: nothing is lost.
TEST(Faults, ARankThatGoesWithItsWeightIsNotLost) {
  for (const char* weight : {"0", "'= time < 10 ms ? 1 : 0'", "'= time < 10 ms ? 0 : 1'"}) {
    StubRig rig(
        "behavior: 1\nrobot: hume\nmachine:\n  contacts: [right_foot, left_foot]\n  tasks:\n"
        "    com: {type: com_position, reference: entry, gains: {kp: 1}, weight: [" +
            std::string(weight) + ", " + weight +
            ", 1]}\n"
            "    attitude: {type: body_orientation, reference: entry, gains: {kp: 1}}\n"
            "    rest: {type: joint_damping, priority: 2, gains: {kd: 2}}\n"
            "  states: {hold: {doc: here}}\n",
        kHeavy);
    rig.loop->start();
    run(rig, 40);
    EXPECT_EQ(rig.faults(Fault::rank_loss), 0) << weight;
    EXPECT_EQ(rig.faults(Fault::non_finite), 0) << weight;
  }
}

class NotANumber : public testing::TestWithParam<double> {};

TEST_P(NotANumber, IsCountedOnceAndStopsARobotThatSaysSo) {
  for (const bool velocity : {false, true}) {
    StubRig rig(kHold, kHeavy, nullptr, [](behaviors::Behavior& b) {
      b.robot.reactions[static_cast<std::size_t>(Fault::non_finite)] = core::Reaction::safe_stop;
    });
    rig.hardware->spoil = [velocity](hal::Sensors& sensors, std::int64_t tick) {
      if (tick >= 20 && tick < 30) (velocity ? sensors.qd : sensors.q)[3] = GetParam();
    };
    rig.loop->start();
    run(rig, 20);
    EXPECT_EQ(rig.loop->state(), LoopState::running);
    EXPECT_EQ(rig.faults(Fault::non_finite), 0);
    run(rig, 30);
    EXPECT_EQ(rig.loop->state(), LoopState::stopped);
    EXPECT_EQ(rig.faults(Fault::non_finite), 1);
  }
}

INSTANTIATE_TEST_SUITE_P(All, NotANumber,
                         testing::Values(std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::infinity()));

TEST(Faults, ANotANumberOfTheBaseStopsTheLoopByDefault) {
  StubRig rig(kHold, kHeavy);
  rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t tick) {
    if (tick == 20) sensors.v_WB[1] = std::nan("");
  };
  rig.loop->start();
  run(rig, 40);
  EXPECT_EQ(rig.loop->state(), LoopState::stopped);
  EXPECT_EQ(rig.faults(Fault::non_finite), 1);
}

TEST(Faults, AnOrientationThatIsNotANumberIsAFaultWhoseReactionIsTheRobots) {
  StubRig rig(kHold, kHeavy, nullptr, [](behaviors::Behavior& b) {
    b.robot.reactions[static_cast<std::size_t>(Fault::non_finite)] = core::Reaction::safe_state;
  });
  rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t tick) {
    if (tick == 20) sensors.q_WB[2] = std::nan("");
  };
  rig.loop->start();
  run(rig, 40);
  EXPECT_EQ(rig.faults(Fault::non_finite), 1);
  EXPECT_EQ(rig.state(), "limp");
}

// Each way to lie on the ground.
struct Fallen {
  const char* name;
  void (*spoil)(hal::Sensors&);
};

// Not its bytes, which hold addresses.
void PrintTo(const Fallen& way, std::ostream* out) { *out << way.name; }

class Fall : public testing::TestWithParam<Fallen> {};

TEST_P(Fall, EndsTheLoopAndIsCountedOnce) {
  StubRig rig(kHold, kHeavy);
  rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t tick) {
    if (tick >= 30) GetParam().spoil(sensors);
  };
  rig.loop->start();
  run(rig, 30);
  EXPECT_EQ(rig.loop->state(), LoopState::running);
  run(rig, 30);
  EXPECT_EQ(rig.loop->state(), LoopState::fallen);
  EXPECT_EQ(rig.faults(Fault::fall), 1);
  EXPECT_EQ(rig.state(), "limp");
}

INSTANTIATE_TEST_SUITE_P(
    Ways, Fall,
    testing::Values(Fallen{"low",
                           [](hal::Sensors& s) {  // knees folded: the hip at 0.2 of its height
                             for (const std::size_t leg : {0U, 3U}) {
                               s.q[leg + 1] = -1.4;
                               s.q[leg + 2] = 2.8;
                             }
                           }},
                    Fallen{"tilt",
                           [](hal::Sensors& s) {
                             s.q_WB = {std::cos(0.45), std::sin(0.45), 0, 0};  // 0.9 rad
                           }},
                    Fallen{"body", [](hal::Sensors& s) { s.body_contact = true; }}),
    [](const testing::TestParamInfo<Fallen>& way) { return std::string(way.param.name); });

TEST(Faults, ATiltJustInsideTheLimitIsNoFall) {
  StubRig rig(kHold, kHeavy);
  rig.hardware->spoil = [](hal::Sensors& s, std::int64_t) {
    s.q_WB = {std::cos(0.395), 0, std::sin(0.395), 0};  // 0.79 of 0.8 rad
  };
  rig.loop->start();
  run(rig, 5);
  EXPECT_EQ(rig.loop->state(), LoopState::running);
}

TEST(Faults, AWarningOfTheSimulatorEndsTheLoopAsAFall) {
  StubRig rig(kHold, kHeavy);
  rig.hardware->spoil = [](hal::Sensors& s, std::int64_t tick) { s.backend_fault = tick >= 5; };
  rig.loop->start();
  run(rig, 10);
  EXPECT_EQ(rig.loop->state(), LoopState::fallen);
  EXPECT_EQ(rig.faults(Fault::simulator_warning), 1);
}

TEST(Faults, TorqueLimitAndTorqueStepAreCountedOnceForEachAppearance) {
  StubRig rig(kHold, kHeavy);
  rig.hardware->spoil = [](hal::Sensors& s, std::int64_t tick) {
    if ((tick >= 50 && tick < 100) || (tick >= 150 && tick < 200)) s.q[0] += 0.5;
  };
  rig.loop->start();
  double largest = 0.0;
  for (int k = 0; k < 300; ++k) {
    rig.loop->tick();
    for (std::size_t j = 0; j < 6; ++j) {
      const double part =
          std::abs(rig.loop->commands().tau[j]) / rig.behavior->robot.joints[j].torque_limit;
      largest = std::max(largest, part);
    }
  }
  EXPECT_DOUBLE_EQ(largest, 1.0);  // clamped, not beyond
  EXPECT_EQ(rig.faults(Fault::torque_limit), 2);
  EXPECT_EQ(rig.faults(Fault::torque_step), 4);  // in and out, twice
  EXPECT_EQ(rig.loop->state(), LoopState::running);
  EXPECT_EQ(rig.state(), "hold");  // both reactions are `continue`
}

TEST(Faults, StaleSensorsAreCountedOnceForEachAppearance) {
  StubRig rig(kHold, kHeavy);
  rig.loop->start();
  rig.hardware->stale = true;
  run(rig, 7);
  EXPECT_EQ(rig.faults(Fault::sensor_stale), 1);
}

TEST(Faults, StaleSensorsAreAnEventEachTimeTheyBegin) {
  StubRig rig(R"(
behavior: 1
robot: hume
parameters: {times: {value: 0, range: [0, 9]}}
machine:
  contacts: [right_foot, left_foot]
  tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 20}}}
  transitions: [{on: fault.sensor.stale, do: [{set: {times: "= $times + 1"}}]}]
  states: {one: {}}
)",
              kHeavy);
  rig.loop->start();
  for (const bool stale : {false, true, false, true, false}) {
    rig.hardware->stale = stale;
    run(rig, 7);
  }
  EXPECT_EQ(rig.loop->machine().parameters()[0], 2.0);
  EXPECT_EQ(rig.faults(Fault::sensor_stale), 2);
  EXPECT_EQ(rig.loop->state(), LoopState::running);
}

TEST(Faults, ASafeStopEntersTheSafeStateAndStopsTheHardware) {
  StubRig rig(kHold, 1.0);
  rig.loop->start();
  run(rig, 5);
  rig.loop->safe_stop();
  rig.hardware->spoil = [](hal::Sensors& s, std::int64_t) { s.qd[0] = 3.0; };
  run(rig, 2);
  EXPECT_EQ(rig.state(), "limp");
  EXPECT_GT(std::abs(rig.loop->commands().tau[0]), 0.0);
  EXPECT_EQ(rig.loop->sensors().tau[0], 0.0);  // commanded, but no torque acts any more
}

// Without a `safe` state there is nowhere to go.
TEST(Faults, ASafeStateThatABehaviorDoesNotHaveIsAStop) {
  StubRig rig(R"(
behavior: 1
robot: hume
machine:
  tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}
)");
  rig.hardware->spoil = [](hal::Sensors& s, std::int64_t tick) { s.imu_fresh = tick < 5; };
  rig.loop->start();
  for (int k = 0; k < 5 + 30; ++k) rig.loop->tick();  // limits.imu_age is 20 ms, 30 ticks
  EXPECT_EQ(rig.loop->state(), engine::LoopState::running);
  rig.loop->tick();
  EXPECT_EQ(rig.loop->state(), engine::LoopState::stopped);
  EXPECT_EQ(rig.loop->ended_by(), Fault::imu_stale);
}

TEST(Faults, WithoutAStateAtTheStartThereIsNoStart) {
  StubRig rig(R"(
behavior: 1
robot: hume
machine:
  tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}
)");
  rig.hardware->spoil = [](hal::Sensors& s, std::int64_t) { s.has_truth = false; };
  EXPECT_THROW(rig.loop->start(), std::runtime_error);
}

constexpr const char* kMeasured = R"(
behavior: 1
robot: hume
estimator: {type: motion_capture}
machine:
  tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}
)";

// The stub's robot stands still while its first frames show too little.
TEST(Faults, AStartWaitsForAFrameThatShowsEnoughMarkers) {
  const auto start = [](int hidden, bool waits) {
    StubRig rig(kMeasured, 1.0, nullptr, [](behaviors::Behavior& b) { b.robot.mocap_age = 10e-3; });
    int reads = 0;
    const model::ControlModel model(rig.behavior->robot);
    rig.hardware->spoil = [&](hal::Sensors& s, std::int64_t) {
      for (std::size_t m = 0; m < 4; ++m) {
        s.marker[m] = model.mounts().markers[m].p_BM;
        s.marker_seen[m] = m < 2 || reads >= hidden;
      }
      ++reads;
    };
    engine::LoopSettings settings;
    settings.waits = waits;
    engine::ControlLoop loop(*rig.behavior, *rig.hardware, settings);
    try {
      loop.start();
    } catch (const engine::NoState& problem) {
      EXPECT_TRUE(problem.markers());
      EXPECT_NE(std::string(problem.what()).find("2 markers at most"), std::string::npos)
          << problem.what();
      return -reads;
    }
    EXPECT_EQ(loop.ticks(), 0);
    return reads;
  };
  EXPECT_EQ(start(0, true), 1);
  EXPECT_EQ(start(15, true), 16);  // 10 ms are 15 ticks
  EXPECT_EQ(start(16, true), -16);
  EXPECT_EQ(start(1, false), -1);
}

// A behavior that marks no step may hold a foot up for as long as it likes, and one that relies on
// no foot at all hangs on something.
TEST(Faults, AFootInTheAirIsASwingOnlyOfABehaviorThatStepsOnAnother) {
  struct Case {
    const char* mark;
    const char* contacts;
    bool swings;
  };
  for (const auto& [mark, contacts, swings] :
       {Case{"pose", "[right_foot]", false}, Case{"step", "[right_foot]", true},
        Case{"step", "[]", false}}) {
    StubRig rig(fmt::format(R"(
behavior: 1
robot: hume
machine:
  tasks: {{rest: {{type: joint_damping, priority: 1, gains: {{kd: 5}}}}}}
  states: {{stand: {{contacts: {}, on_entry: [{{mark: {}}}]}}}}
)",
                            contacts, mark),
                1e6, [](int contact, double) { return contact == 0; });
    rig.loop->start();
    for (int k = 0; k < 1500; ++k) rig.loop->tick();  // 1 s
    EXPECT_EQ(rig.faults(Fault::swing_too_long), 0);
    rig.loop->tick();
    EXPECT_EQ(rig.faults(Fault::swing_too_long), swings ? 1 : 0);
    EXPECT_EQ(rig.loop->state(), swings ? engine::LoopState::fallen : engine::LoopState::running);
    EXPECT_EQ(rig.loop->last_place(Fault::swing_too_long).joint, swings ? 1 : -1);
  }
}

}  // namespace
}  // namespace footfall::tests
