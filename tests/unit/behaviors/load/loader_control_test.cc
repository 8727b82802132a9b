// Stacks, tasks, gains, references and contact transitions in a file, on Hume.
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

// A behavior with one stack; `tasks` and `machine` are YAML in flow style.
std::string with_stack(const std::string& tasks, const std::string& machine = "{stack: s}",
                       const std::string& more = "") {
  return "behavior: 1\nrobot: hume\nstacks:\n  s:\n    contacts: [right_foot, left_foot]\n"
         "    tasks: " +
         tasks + "\n" + more + "machine: " + machine + "\n";
}

TEST(LoaderControl, AMissingPointComesWithASuggestion) {
  EXPECT_EQ(problems(with_stack(
                "{f: {type: point_position, point: right_fot, reference: 0, gains: {kp: 1}}}")),
            "b.yaml:6:46: error: unknown point 'right_fot' (did you mean 'right_foot'?)\n");
}
TEST(LoaderControl, AnUnknownTaskTypeComesWithASuggestion) {
  EXPECT_EQ(problems(with_stack("{f: {type: com_postion, reference: 0, gains: {kp: 1}}}")),
            "b.yaml:6:23: error: unknown task type 'com_postion' (did you mean 'com_position'?)\n");
}
TEST(LoaderControl, AMissingGainEntryIsAnError) {
  EXPECT_EQ(problems(with_stack("{f: {type: com_position, reference: 0}}", "{stack: s}",
                                "    gains: g\ngains: {g: {other: {kp: 1}}}\n")),
            "b.yaml:6:13: error: task 'f' has no gains: none in it, none in table 'g'\n");
}
TEST(LoaderControl, GainsHaveTheirDimensionsAndSizes) {
  EXPECT_EQ(problems(with_stack("{f: {type: com_position, axes: [x, z], reference: 0,"
                                " gains: {kp: [1, 2, 3], kd: 5 m, ko: 1}}}")),
            "b.yaml:6:77: error: expected 2 values (x, z), got 3\n"
            "b.yaml:6:92: error: expected a rate (1/s), got '5 m'\n"
            "b.yaml:6:97: error: unknown key 'ko' (did you mean 'kp'?)\n");
}
TEST(LoaderControl, ATaskNeedsAReference) {
  EXPECT_EQ(problems(with_stack("{f: {type: com_position, gains: {kp: 1}}}")),
            "b.yaml:6:13: error: task 'f' needs a `reference`\n");
}
TEST(LoaderControl, AReferenceHasAValueForEachAxis) {
  EXPECT_EQ(problems(with_stack(
                "{f: {type: com_position, axes: [x, z], gains: {kp: 1}, reference: [1 m]}}")),
            "b.yaml:6:78: error: expected 2 values, one for each of x z, got 1\n");
  EXPECT_EQ(problems(with_stack(
                "{f: {type: com_position, axes: [x, z], gains: {kp: 1}, reference: {x: 1 m}}}")),
            "b.yaml:6:78: error: no value for 'z'\n");
}
TEST(LoaderControl, AReferenceHasTheTasksDimension) {
  EXPECT_EQ(problems(with_stack(
                "{f: {type: com_position, axes: [z], gains: {kp: 1}, reference: 3 deg}}")),
            "b.yaml:6:75: error: expected a length, got '3 deg'\n");
}
TEST(LoaderControl, UnknownStacksAndTablesComeWithASuggestion) {
  EXPECT_EQ(problems(with_stack("{}", "{states: {a: {stack: ss}, b: {stack: s, gains: h}}}",
                                "    gains: g\ngains: {g: {}}\n")),
            "b.yaml:9:31: error: unknown stack 'ss' (did you mean 's'?)\n");
}
TEST(LoaderControl, AnOverlayOnATaskThatIsNotThereIsAnError) {
  EXPECT_EQ(
      problems(with_stack("{height: {type: com_position, axes: [z], reference: 0, gains: {kp: 1}}}",
                          "{stack: s, tasks: {hieght: {reference: 1 m}}}")),
      "b.yaml:7:29: error: task 'hieght' is not in the stack in force, and has no type (did "
      "you mean 'height'?)\n");
}
TEST(LoaderControl, OffRemovesATask) {
  const auto b =
      load(with_stack("{height: {type: com_position, axes: [z], reference: 0, gains: {kp: 1}},"
                      " rest: {type: joint_damping, gains: {kd: 1}}}",
                      "{stack: s, states: {a: {after: 1 s, to: b}, b: {tasks: {height: off}}}}"));
  ASSERT_EQ(b->controls.size(), 2u);
  EXPECT_EQ(b->controls[0].tasks.count, 2);
  EXPECT_EQ(b->controls[1].tasks.count, 1);
}
TEST(LoaderControl, TasksStandByPriorityThenInTheOrderOfTheFile) {
  const auto b =
      load(with_stack("{a: {type: joint_damping, priority: 2, gains: {kd: 1}},"
                      " b: {type: joint_damping, priority: 1, gains: {kd: 1}},"
                      " c: {type: joint_damping, priority: 2, gains: {kd: 1}}}"));
  std::string order;
  for (const auto& task : b->tasks) {
    order += b->task_instances[static_cast<std::size_t>(task.instance)].name;
  }
  EXPECT_EQ(order, "bac");
}
TEST(LoaderControl, JointTasksTakeGlobs) {
  const auto b =
      load(with_stack("{k: {type: joint_posture, joints: [\"*_knee\"], reference: {right_knee: 1,"
                      " \"left*\": 2}, gains: {kp: {\"*_knee\": 7}}}}"));
  ASSERT_EQ(b->tasks.size(), 1u);
  EXPECT_EQ(b->tasks[0].axes.count, 2);
  const auto* axis = &b->axes[static_cast<std::size_t>(b->tasks[0].axes.first)];
  EXPECT_EQ(b->robot.joints[static_cast<std::size_t>(axis[0].axis)].name, "right_knee");
  EXPECT_EQ(b->values[static_cast<std::size_t>(axis[1].kp)], 7.0);
}
TEST(LoaderControl, DampingHasNoStiffness) {
  EXPECT_EQ(problems(with_stack("{k: {type: joint_damping, gains: {kp: 1, kd: 2}}}")),
            "b.yaml:6:50: error: joint_damping has kd only, no kp\n");
}
TEST(LoaderControl, ARangeLimitsGains) {
  EXPECT_EQ(problems(with_stack("{k: {type: joint_damping, gains: {kd: 200}}}", "{stack: s}",
                                "gains: {ranges: {kd: [0, 120]}}\n")),
            "b.yaml:6:50: error: '200' is outside gains.ranges, 0 to 120\n");
}
TEST(LoaderControl, RegionsMayNotControlTheSameTask) {
  const std::string text = with_stack("{}",
                                      "\n  type: parallel\n  stack: s\n  states:\n"
                                      "    l: {tasks: {k: {type: joint_damping, gains: {kd: 1}}}}\n"
                                      "    r: {tasks: {k: {type: joint_damping, gains: {kd: 2}}}}");
  EXPECT_EQ(problems(text), "b.yaml:12:17: error: task 'k' is given by 'l' and by 'r' at once\n");
}
TEST(LoaderControl, RegionsMayEachContributeTasks) {
  const auto b = load(with_stack(
      "{}",
      "\n  type: parallel\n  stack: s\n  states:\n"
      "    l: {states: {a: {tasks: {k: {type: joint_damping, gains: {kd: 1}}}}, b: {}}}\n"
      "    r: {states: {c: {}, d: {tasks: {m: {type: joint_damping, gains: {kd: 2}}}}}}"));
  ASSERT_EQ(b->controls.size(), 4u);
  const auto weight = [&](const char* path) {
    return b->states[static_cast<std::size_t>(b->find_state(path))].control_weight;
  };
  const auto tasks = [&](const char* l, const char* r) {
    return b->controls[static_cast<std::size_t>(weight(l) + weight(r))].tasks.count;
  };
  EXPECT_EQ(tasks("l.a", "r.c"), 1);
  EXPECT_EQ(tasks("l.a", "r.d"), 2);
  EXPECT_EQ(tasks("l.b", "r.c"), 0);
  EXPECT_EQ(tasks("l.b", "r.d"), 1);
}
TEST(LoaderControl, ALoadedFootMustBeInContactInTheStackToCome) {
  EXPECT_EQ(
      problems("behavior: 1\nrobot: hume\nstacks: {one: {contacts: [right_foot]}}\nmachine:\n"
               "  states:\n    a: {stack: one, contact_transition: {loads: left_foot, over: 24 ms,"
               " toward: one}}\n"),
      "b.yaml:6:81: error: stack 'one' does not have 'left_foot' in contact\n");
}
TEST(LoaderControl, AReleasedFootMayNotHold) {
  EXPECT_EQ(
      problems(
          "behavior: 1\nrobot: hume\nmachine:\n  states:\n"
          "    a: {contacts: [right_foot], contact_transition: {releases: right_foot, over: 24 "
          "ms}}\n"),
      "b.yaml:5:5: error: 'right_foot' is released here, but the state's contacts hold it\n");
}
TEST(LoaderControl, ATransitionEitherReleasesOrLoads) {
  EXPECT_EQ(problems("behavior: 1\nrobot: hume\nmachine:\n  states:\n"
                     "    a: {contact_transition: {over: 24 ms}}\n"),
            "b.yaml:5:29: error: expected either `releases` or `loads`\n");
}
TEST(LoaderControl, TorqueLoopsAreCheckedAndStored) {
  core::Diagnostics diagnostics;
  const auto b = behaviors::load_behavior(balance_path(), options_for_tests(), diagnostics);
  ASSERT_TRUE(b);
  ASSERT_EQ(b->torque_loops.size(), 2u);
  const auto hip = static_cast<std::size_t>(b->robot.find_joint("left_hip"));
  EXPECT_EQ(b->values[static_cast<std::size_t>(b->torque_loops[1].slots[0]) + hip], 32.7);
  EXPECT_EQ(b->controls[0].torque_loops[hip], 0);  // rise: stance
  EXPECT_EQ(
      problems("behavior: 1\nrobot: hume\ntorque_loop: {st: {p: {\"*hop\": 1}}}\nmachine: "
               "{torque_loop: {right_fot: st, left_leg: sy}}\n"),
      "b.yaml:3:24: error: '*hop' matches no joint: there are right_abduction, right_hip, "
      "right_knee, "
      "left_abduction, left_hip, left_knee\n"
      "b.yaml:4:25: error: 'right_fot' is neither a foot with a leg nor a joint group (did you "
      "mean 'right_foot'?)\n"
      "b.yaml:4:50: error: unknown torque_loop table 'sy' (did you mean 'st'?)\n");
}
TEST(LoaderControl, PlannersAreChecked) {
  EXPECT_EQ(
      problems("behavior: 1\nrobot: hume\nplanners:\n  foot: {type: velocity_reversal, kapa: 1,"
               " reversal: [0 s, 1 s], goal: $gaol, reach: {x: 35 cm, y: [0.5 m, 0.1 m]}}\n"
               "parameters: {goal: {value: [0, 0]}}\nmachine: {}\n"),
      "b.yaml:4:35: error: unknown key 'kapa' (did you mean 'kappa'?)\n"
      "b.yaml:4:54: error: the time to velocity reversal must be above 0 s\n"
      "b.yaml:4:72: error: unknown parameter '$gaol' (did you mean 'goal'?)\n"
      "b.yaml:4:100: error: expected [minimum, maximum], got '0.5 m' before '0.1 m'\n");
}
TEST(LoaderControl, InvokesAreChecked) {
  EXPECT_EQ(problems("behavior: 1\nrobot: hume\nplanners: {foot: {type: velocity_reversal, kappa: "
                     "1, reversal: 1 s}}\nmachine:\n"
                     "  states:\n    a:\n      invoke:\n        - {planner: fot, at: 70 %, with: "
                     "{stance: right_foot, swing: right_foot, switch_in: 1 m}}\n"),
            "b.yaml:8:21: error: unknown planner 'fot' (did you mean 'foot'?)\n"
            "b.yaml:8:30: error: '70 %' of what? The state has no `after` + `to`\n"
            "b.yaml:8:70: error: stance and swing are the same foot\n"
            "b.yaml:8:93: error: expected a time, got '1 m'\n");
}
TEST(LoaderControl, StacksThatNobodyNamesAreWarnings) {
  EXPECT_EQ(problems(with_stack("{}", "{}")),
            "b.yaml:4:3: warning: stack 's' is never used, and not checked\n");
}
TEST(LoaderControl, InternalForcesAreStoredByContact) {
  const auto b = load(
      "behavior: 1\nrobot: hume\nmachine: {contacts: [right_foot, left_foot], internal: "
      "{tension: {between: [right_foot, left_foot], reference: 100 N, feedback: 1.5, "
      "convention: sum}}}\n");
  ASSERT_EQ(b->internals.size(), 1u);
  EXPECT_EQ(b->internals[0].contacts[1], 1);
  EXPECT_EQ(b->internals[0].scale, 0.5);
  EXPECT_GE(b->signals.find("internal.tension.measured"), 0);
}

}  // namespace
}  // namespace footfall::tests
