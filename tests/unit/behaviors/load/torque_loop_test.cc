// `torque_loop:` tables: types, units, precedence, slots, --set, and the gains in force.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "behaviors/compiled/take_over_map.h"
#include "behaviors/compiled/torque_loops.h"
#include "tests/support/allocation_guard.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

using behaviors::Behavior;
using behaviors::LoadOptions;
using behaviors::torque_loop_gains;
using hal::TorqueLoopGains;

// A behavior with these tables, which its right and left leg use.
std::string with_loops(const std::string& tables, const std::string& right = "t",
                       const std::string& left = "off") {
  return "behavior: 1\nrobot: hume\ntorque_loop:\n" + tables +
         "machine: {torque_loop: {right_leg: " + right + ", left_leg: " + left + "}}\n";
}

// Hume with other drives.
LoadOptions with_drives(const std::string& name, const std::string& drives) {
  const std::string path = testing::TempDir() + "/footfall_" + name + ".yaml";
  std::ofstream(path) << "robot: 1\nbase: "
                      << std::filesystem::absolute(FOOTFALL_SOURCE_DIR).string()
                      << "/robots/hume/robot.yaml\ndrives: " << drives << "\n";
  LoadOptions options = options_for_tests();
  options.robot = path;
  return options;
}

TorqueLoopGains gains_of(const Behavior& b, const char* joint) {
  return torque_loop_gains(b, b.controls[0], b.robot.find_joint(joint), b.values);
}

TEST(TorqueLoopTable, AnExactNameBeatsAGlobAndAGlobBeatsTheRobot) {
  const auto b = load(with_loops(
      "  t: {type: direct, p: {right_hip: 3, \"*hip\": 2}, d: {right_hip: 11}, i: 1}\n"));
  EXPECT_EQ(gains_of(*b, "right_hip").p, 3.0);
  EXPECT_EQ(gains_of(*b, "right_knee").p, 20.0);  // the robot's, of the same type
  EXPECT_EQ(gains_of(*b, "right_hip").damping, 11.0);
  EXPECT_EQ(gains_of(*b, "right_knee").damping, 38.6);
  EXPECT_EQ(gains_of(*b, "right_knee").i, 1.0);
  EXPECT_EQ(gains_of(*b, "right_hip").damps, TorqueLoopGains::Damping::spring);
}

TEST(TorqueLoopTable, OfAnotherTypeTakesTheRobotsInnerGainsButNotItsPAndI) {
  const auto b = load(with_loops("  t: {p: {right_hip: 43}}\n"));
  EXPECT_EQ(gains_of(*b, "right_hip").type, TorqueLoopGains::Type::cascade);
  EXPECT_EQ(gains_of(*b, "right_hip").p, 43.0);
  EXPECT_EQ(gains_of(*b, "right_knee").p, 0.0);
  EXPECT_EQ(gains_of(*b, "right_knee").velocity_p, 5.0);
}

TEST(TorqueLoopTable, OnARobotWithoutDrivesHasTheDefaults) {
  const auto b = load(with_loops("  t: {type: direct, i: 1}\n"), with_drives("no_drives", "off"));
  const TorqueLoopGains gains = gains_of(*b, "right_hip"), none = gains_of(*b, "left_hip");
  EXPECT_EQ(gains.p, 0.0);
  EXPECT_EQ(gains.i, 1.0);
  EXPECT_EQ(gains.forward, 1.0);
  EXPECT_EQ(gains.damps, TorqueLoopGains::Damping::motor);
  EXPECT_EQ(none.type, TorqueLoopGains::Type::cascade);
  EXPECT_EQ(none.i, 0.0);
}

TEST(TorqueLoopTable, AJointWithoutTableHasTheRobotsGains) {
  const auto b = load(with_loops("  t: {type: direct, p: 3}\n"));
  EXPECT_EQ(gains_of(*b, "left_hip").p, 20.0);
  EXPECT_EQ(gains_of(*b, "left_hip").damping, 40.2);
  const auto without = load("behavior: 1\nrobot: hume\nmachine: {}\n");
  EXPECT_EQ(gains_of(*without, "left_hip").damping, 40.2);
}

TEST(TorqueLoopTable, TheGainsInForceFollowTheValuesWithoutHeapCalls) {
  const auto b = load(with_loops("  t: {type: direct, p: 3, damps: motor}\n"));
  std::vector<double> values = b->values;
  const int joint = b->robot.find_joint("right_knee");
  values[static_cast<std::size_t>(b->torque_loops[0].slots[0] + joint)] = 7.5;
  TorqueLoopGains gains;
  const AllocationGuard guard;
  gains = torque_loop_gains(*b, b->controls[0], joint, values);
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(gains.p, 7.5);
  EXPECT_EQ(gains.damps, TorqueLoopGains::Damping::motor);
  EXPECT_EQ(gains_of(*b, "right_knee").p, 3.0);
}

TEST(TorqueLoopTable, AGainIsOneValueAJointUnderTheTablesName) {
  const auto b = load(with_loops(
      "  ranges: {p: [1, 60 rad/s/Nm], i: [0, 5]}\n  t: {p: 43 rad/s/Nm, velocity_p: 5}\n"));
  const auto& p = b->parameters[static_cast<std::size_t>(b->find_parameter("torque_loop.t.p"))];
  EXPECT_EQ(p.size, 6);
  EXPECT_TRUE(p.gain && p.live && p.of_torque_loop());
  EXPECT_EQ(p.min, 1.0);
  EXPECT_EQ(p.max, 60.0);
  EXPECT_EQ(p.axes[2], "right_knee");
  EXPECT_EQ(core::unit_text(p.dimension), "rad/s/Nm");
  EXPECT_EQ(b->find_parameter_part("torque_loop.t.p.right_knee").component, 2);
  const int inner = b->find_parameter("torque_loop.t.velocity_p");
  EXPECT_FALSE(b->parameters[static_cast<std::size_t>(inner)].live);  // without range
  EXPECT_EQ(b->find_parameter("torque_loop.t.i"), -1);                // not named in the table
}

TEST(TorqueLoopTable, EveryUnitIsOfTheTablesType) {
  EXPECT_EQ(
      problems(with_loops("  t: {p: 43 rad/s/Nm, i: 0.15 rad/s^2/Nm, velocity_p: 5 Nm s/rad,\n"
                          "      velocity_i: 1 Nm/rad}\n"
                          "  s: {type: direct, p: 20, i: 3 1/s, d: 36 Nm s/rad, damps: spring,\n"
                          "      forward: 90 %, observer: 50 Hz}\n",
                          "t", "s")),
      "");
  EXPECT_EQ(problems(with_loops("  t: {p: 3 1/s, i: 2 rad/s/Nm, velocity_p: 1 Nm}\n")),
            "b.yaml:4:10: error: expected a motor velocity per torque (rad/s/Nm), got '3 1/s'\n"
            "b.yaml:4:20: error: expected a motor acceleration per torque (rad/s^2/Nm), got '2 "
            "rad/s/Nm'\n"
            "b.yaml:4:44: error: expected a damping (Nm s/rad), got '1 Nm'\n");
  EXPECT_EQ(
      problems(with_loops("  t: {type: direct, p: {\"*knee\": 3 rad/s/Nm}, observer: 3 s}\n")),
      "b.yaml:4:34: error: expected a plain number, got '3 rad/s/Nm'\n"
      "b.yaml:4:57: error: expected a frequency (Hz), got '3 s'\n");
}

TEST(TorqueLoopTable, KeysOfTheOtherTypeAreRefused) {
  EXPECT_EQ(problems(with_loops("  t: {p: 1, d: 3, damps: motor}\n")),
            "b.yaml:4:13: error: 'd' is of type direct; a cascade takes p, i, velocity_p, "
            "velocity_i\n"
            "b.yaml:4:19: error: 'damps' is of type direct; a cascade takes p, i, velocity_p, "
            "velocity_i\n");
  EXPECT_EQ(problems(with_loops("  t: {type: direct, velocity_p: 1}\n")),
            "b.yaml:4:21: error: 'velocity_p' is of type cascade; a direct one takes p, i, d, "
            "forward, observer, damps\n");
}

TEST(TorqueLoopTable, WhatIsNegativeOrNoNumberOrOutOfRangeIsRefused) {
  EXPECT_EQ(problems(with_loops("  t: {p: -1, i: [1, 2]}\n")),
            "b.yaml:4:10: error: expected a motor velocity per torque (rad/s/Nm), at least 0 "
            "rad/s/Nm, got '-1'\n"
            "b.yaml:4:17: error: expected a motor acceleration per torque (rad/s^2/Nm), got a "
            "list\n");
  EXPECT_EQ(
      problems(with_loops("  ranges: {p: [2, 9]}\n  t: {p: {right_hip: 10, \"*knee\": 1}}\n")),
      "b.yaml:5:10: error: joint 'right_abduction', not named here, has 0, which is outside "
      "torque_loop.ranges, 2 to 9\n"
      "b.yaml:5:22: error: '10' is outside torque_loop.ranges, 2 to 9\n"
      "b.yaml:5:35: error: '1' is outside torque_loop.ranges, 2 to 9\n");
  EXPECT_EQ(
      problems(with_loops("  ranges: {p: [-1, 9], i: [3, 3], d: [2 Nm, 3], q: [1, 2]}\n"
                          "  t: {p: 1}\n")),
      "b.yaml:4:16: error: expected 0 or more, got '-1': a gain cannot be negative\n"
      "b.yaml:4:27: error: a range must not be empty\n"
      "b.yaml:4:39: error: expected a damping (Nm s/rad), got '2 Nm'\n"
      "b.yaml:4:49: error: unknown key 'q', expected p, i, d, forward, observer, velocity_p or "
      "velocity_i\n");
}

TEST(TorqueLoopTable, RangesIsNoTable) {
  EXPECT_EQ(problems(with_loops("  ranges: {p: [0, 9]}\n  t: {p: 1}\n", "t", "ranges")),
            "b.yaml:6:49: error: unknown torque_loop table 'ranges' (there is t)\n");
  EXPECT_EQ(problems(with_loops("  ranges: {p: [0, 9]}\n  t: {p: 1}\n  u: {p: 2}\n")),
            "b.yaml:6:3: warning: torque_loop table 'u' is never used\n");
}

TEST(TorqueLoopTable, ARangeHoldsForTablesOfBothTypesWithoutUnits) {
  const auto b = load(
      with_loops("  ranges: {p: [0, 60]}\n  t: {p: 43}\n  u: {type: direct, p: 20}\n", "t", "u"));
  for (const char* name : {"torque_loop.t.p", "torque_loop.u.p"}) {
    EXPECT_EQ(b->parameters[static_cast<std::size_t>(b->find_parameter(name))].max, 60.0) << name;
  }
}

// A reload keeps edited values by name, also where tables moved; p of another type is another
// value.
TEST(TorqueLoopTable, AReloadMapsItsValuesByName) {
  const auto from = load(with_loops("  t: {p: 43, i: 1}\n  u: {p: 20}\n", "t", "u"));
  const auto to =
      load(with_loops("  u: {type: direct, p: 20}\n  t: {i: 2, p: {\"*\": 40}}\n", "t", "u"));
  const behaviors::TakeOverMap map = behaviors::map_take_over(*from, *to);
  const auto slot = [](const Behavior& b, const char* name) {
    return b.parameters[static_cast<std::size_t>(b.find_parameter(name))].slot;
  };
  const auto mapped = [&](const char* name, int joint) {
    return map.slots[static_cast<std::size_t>(slot(*to, name) + joint)];
  };
  for (int joint = 0; joint < 6; ++joint) {
    EXPECT_EQ(mapped("torque_loop.t.p", joint), slot(*from, "torque_loop.t.p") + joint);
    EXPECT_EQ(mapped("torque_loop.t.i", joint), slot(*from, "torque_loop.t.i") + joint);
    EXPECT_EQ(mapped("torque_loop.u.p", joint), -1);
  }
}

LoadOptions with_settings(const std::vector<std::pair<std::string, std::string>>& settings) {
  LoadOptions options = options_for_tests();
  options.set = settings;
  return options;
}

TEST(TorqueLoopTable, SetReplacesAllJointsOrOneByNameOrNumber) {
  const std::string text = with_loops(
      "  ranges: {p: [0, 60]}\n  t: {type: direct, p: {\"*\": 3, right_hip: 4}, d: 30}\n");
  const auto all = load(text, with_settings({{"torque_loop.t.p", "20"}}));
  EXPECT_EQ(gains_of(*all, "right_hip").p, 20.0);
  EXPECT_EQ(gains_of(*all, "right_knee").p, 20.0);
  const auto one = load(text, with_settings({{"torque_loop.t.p.right_knee", "25"},
                                             {"torque_loop.t.d[1]", "31 Nm s/rad"},
                                             {"torque_loop.t.i.right_hip", "2"}}));
  EXPECT_EQ(gains_of(*one, "right_hip").p, 4.0);
  EXPECT_EQ(gains_of(*one, "right_knee").p, 25.0);
  EXPECT_EQ(gains_of(*one, "right_abduction").p, 3.0);
  EXPECT_EQ(gains_of(*one, "right_hip").damping, 31.0);
  EXPECT_EQ(gains_of(*one, "right_knee").damping, 30.0);
  EXPECT_EQ(gains_of(*one, "right_hip").i, 2.0);
  EXPECT_EQ(gains_of(*one, "right_knee").i, 0.0);
}

TEST(TorqueLoopTable, SetIsCheckedLikeTheFile) {
  const std::string text = with_loops("  ranges: {p: [0, 60]}\n  t: {p: 3}\n");
  const auto refusal = [&](const char* name, const char* value) {
    return problems(text, with_settings({{name, value}}));
  };
  EXPECT_EQ(refusal("torque_loop.t.p.right_knee", "61"),
            "--set torque_loop.t.p.right_knee:1:1: error: '61' is outside torque_loop.ranges, 0 to "
            "60\n");
  EXPECT_EQ(refusal("torque_loop.t.p", "3 s"),
            "--set torque_loop.t.p:1:1: error: expected a motor velocity per torque (rad/s/Nm), "
            "got '3 s'\n");
  EXPECT_NE(refusal("torque_loop.t.p.rigt_knee", "3").find("did you mean 'right_knee'?"),
            std::string::npos);
  EXPECT_NE(refusal("torque_loop.s.p", "3").find("there is no 's'"), std::string::npos);
  EXPECT_NE(refusal("torque_loop.t.d", "3").find("'d' is of type direct"), std::string::npos);
  EXPECT_NE(refusal("torque_loop.ranges.p", "3").find("expected torque_loop.TABLE.GAIN"),
            std::string::npos);
}

}  // namespace
}  // namespace footfall::tests
