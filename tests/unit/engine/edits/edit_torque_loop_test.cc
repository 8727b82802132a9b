// Live edits of torque loops: within their ranges, by table or by joint, reported as gains are.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "behaviors/compiled/torque_loops.h"
#include "engine/edits/door.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

using engine::EditBatch;

constexpr const char* kLoops =
    "behavior: 1\nrobot: hume\n"
    "torque_loop:\n  ranges: {p: [1, 60]}\n  stance: {p: {\"*hip\": 43, \"*knee\": 22, "
    "\"*abduction\": 3}, velocity_p: "
    "5}\n"
    "machine: {torque_loop: {right_leg: stance, left_leg: stance}}\n";

struct EditTorqueLoop : testing::Test {
  EditTorqueLoop() : door(*runner.behavior, 16) { runner.start(); }

  EditBatch edit(const std::string& name, const std::vector<double>& values) {
    EditBatch batch;
    std::vector<std::string> reasons;
    const auto part = runner.behavior->find_parameter_part(name);
    engine::add_values(*runner.behavior, part, values, batch.values, reasons);
    EXPECT_TRUE(reasons.empty());
    return batch;
  }
  std::string refusal(const std::string& name, double value) {
    std::string text;
    for (const auto& reason : engine::reasons_against(*runner.behavior, edit(name, {value}), 0)) {
      text += reason + "\n";
    }
    return text;
  }
  double p(const char* joint) {
    const behaviors::Behavior& b = *runner.behavior;
    return torque_loop_gains(b, b.controls[0], b.robot.find_joint(joint),
                             runner.machine.parameters())
        .p;
  }
  // Ticks until the robot's ramp of live edits has ended.
  void settle() {
    const behaviors::Behavior& b = *runner.behavior;
    for (int k = 0; k <= static_cast<int>(b.robot.edit_ramp / b.period()) + 1; ++k) {
      door.apply(runner.now, runner.machine);
      runner.tick();
      const double now = p("right_hip");
      EXPECT_TRUE(now >= std::min(43.0, target) && now <= std::max(43.0, target)) << now;
    }
  }

  Runner runner{load(kLoops)};
  engine::EditDoor door;
  double target = 43.0;  // of the right hip
};

TEST_F(EditTorqueLoop, OneJointsGainRampsToItsNewValueAndTheOthersStay) {
  target = 50.0;
  EXPECT_TRUE(door.submit(edit("torque_loop.stance.p.right_hip", {target})).accepted());
  EXPECT_EQ(p("right_hip"), 43.0);
  settle();
  EXPECT_EQ(p("right_hip"), 50.0);
  EXPECT_EQ(p("left_hip"), 43.0);
}

TEST_F(EditTorqueLoop, AllJointsAreEditedTogether) {
  target = 11.0;
  EXPECT_TRUE(
      door.submit(edit("torque_loop.stance.p", {10.0, target, 12.0, 13.0, 14.0, 15.0})).accepted());
  settle();
  EXPECT_EQ(p("right_abduction"), 10.0);
  EXPECT_EQ(p("right_hip"), 11.0);
  EXPECT_EQ(p("left_knee"), 15.0);
}

TEST_F(EditTorqueLoop, WhatIsOutOfRangeNegativeOrNotFiniteIsRefused) {
  EXPECT_EQ(refusal("torque_loop.stance.p.right_hip", 61.0),
            "torque_loop.stance.p.right_hip: 61 rad/s/Nm is out of its range, 1 rad/s/Nm to 60 "
            "rad/s/Nm\n");
  EXPECT_EQ(refusal("torque_loop.stance.p.right_hip", -1.0),
            "torque_loop.stance.p.right_hip: -1 rad/s/Nm is out of its range, 1 rad/s/Nm to 60 "
            "rad/s/Nm\n");
  EXPECT_EQ(refusal("torque_loop.stance.p.right_hip", std::numeric_limits<double>::infinity()),
            "torque_loop.stance.p.right_hip: inf is not a finite number\n");
}

TEST_F(EditTorqueLoop, AGainWithoutRangeIsNotLive) {
  EXPECT_EQ(refusal("torque_loop.stance.velocity_p.right_hip", 6.0),
            "torque_loop.stance.velocity_p: not live, because its table has no range for it: give "
            "one under 'torque_loop.ranges'\n");
}

}  // namespace
}  // namespace footfall::tests
