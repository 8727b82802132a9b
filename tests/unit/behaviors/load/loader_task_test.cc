// Task types, frames, limits and gains by axis, trajectories and internal forces in a file, on
// Hume.
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

// A machine in dual support with these tasks; `reference` of the second form.
std::string with(const std::string& tasks, const std::string& more = "") {
  return "behavior: 1\nrobot: hume\n" + more +
         "machine:\n  contacts: [right_foot, left_foot]\n  tasks: " + tasks + "\n";
}
std::string moving(const std::string& reference) {
  return with(
      "{f: {type: com_position, axes: [x, z], gains: {kp: 1},\n    reference: " + reference + "}}");
}

TEST(LoaderTask, EveryTaskTypeLoads) {
  EXPECT_EQ(problems(with(R"(
    a: {type: frame_orientation, point: left_foot, reference: 0, gains: {kp: 1, kd: 1}}
    b: {type: frame_pose, point: torso_top, axes: [z, pitch], reference: {z: 1 m, pitch: 3 deg}, gains: {kp: 1, kd: 1}}
    c: {type: centroidal_angular_momentum, axes: [y], reference: 0.1 kg m^2/s, gains: {kp: 1, kd: 2}}
    d: {type: com_position, frame: stance, axes: [x], reference: 1 cm, gains: {kp: 1, kd: 1}}
    e: {type: body_orientation, frame: world, reference: 0, gains: {kp: 1, kd: 1}}
    f: {type: joint_posture, joints: ["*_knee"], reference: 0, gains: {kp: 1, kd: 1}}
    g: {type: joint_damping, gains: {kd: 1}}
    h: {type: point_position, point: torso_top, reference: 0, gains: {kp: 1, kd: 1}})")),
            "");
}
TEST(LoaderTask, APoseHasLengthsAndAngles) {
  EXPECT_EQ(
      problems(with("{p: {type: frame_pose, point: left_foot, axes: [z, pitch], gains: {kp: 1}, "
                    "reference: [3 deg, 1 m]}}")),
      "b.yaml:5:97: error: expected a length, got '3 deg'\n"
      "b.yaml:5:104: error: expected a plain number, got '1 m'\n");
  const auto b =
      load(with("{p: {type: frame_pose, point: left_foot, gains: {kp: 1}, reference: "
                "{trajectory: polynomial, order: 3, over: 1 s, "
                "to: {z: \"= entry.z + 1 cm\", pitch: \"= entry + 2 deg\"}}}}"));
  EXPECT_EQ(b->signals.info(b->signals.find("task.p.error")).dimension, core::kLength);
  EXPECT_EQ(b->signals.info(b->signals.find("task.p.error.yaw")).dimension, core::kNone);
  EXPECT_EQ(b->signals.info(b->signals.find("task.p.commanded.x")).dimension, core::kAcceleration);
}
TEST(LoaderTask, AMomentumHasNoKiAndItsOwnDimension) {
  EXPECT_EQ(problems(with("{m: {type: centroidal_angular_momentum, reference: 1 m, "
                          "gains: {kd: 1, ki: 2}}}")),
            "b.yaml:5:61: error: expected a value in Nm s, got '1 m'\n"
            "b.yaml:5:85: error: an angular momentum has kd (on its error) and kp (on that error's "
            "integral), no ki\n");
}
TEST(LoaderTask, AFrameOfAnotherTypeIsRefused) {
  EXPECT_EQ(
      problems(with("{f: {type: com_position, frame: heading, reference: 0, gains: {kp: 1}}}")),
      "b.yaml:5:42: error: a com_position has the frame world or stance, got 'heading'\n");
  EXPECT_EQ(
      problems(with("{f: {type: body_orientation, axes: [pitch], frame: world, reference: 0, "
                    "gains: {kp: 1}}}")),
      "b.yaml:5:61: error: about the world's axes roll and pitch go together: one alone means "
      "nothing at another yaw (take `frame: heading`)\n");
}
TEST(LoaderTask, TheStanceFrameNeedsAContact) {
  EXPECT_EQ(
      problems("behavior: 1\nrobot: hume\nmachine: {contacts: [], tasks: {f: {type: "
               "com_position, frame: stance, reference: 0, gains: {kp: 1}}}}\n"),
      "b.yaml:3:64: error: task 'f' is measured from the stance contacts: none is in force\n");
}
TEST(LoaderTask, LimitsAndWeightsAreByAxis) {
  const auto b =
      load(with("{f: {type: com_position, axes: [x, z], reference: 0, gains: {kp: 1}, "
                "acceleration_limit: {z: 2 m/s^2}, integral_limit: [1 m s, 2 m s], "
                "weight: 3}}"));
  ASSERT_EQ(b->axes.size(), 2u);
  EXPECT_EQ(b->axes[0].acceleration_limit, -1);
  EXPECT_GE(b->axes[1].acceleration_limit, 0);
  const auto value = [&](int expression) {
    return behaviors::evaluate(b->expressions, expression, {});
  };
  EXPECT_EQ(value(b->axes[1].acceleration_limit), 2.0);
  EXPECT_EQ(value(b->axes[1].integral_limit), 2.0);
  EXPECT_EQ(value(b->axes[0].weight), 3.0);
  EXPECT_EQ(problems(with("{f: {type: com_position, axes: [x, z], reference: 0, gains: {kp: 1}, "
                          "acceleration_limit: [1 m/s^2, -1 m/s^2], weight: 2 m}}")),
            "b.yaml:5:109: error: acceleration_limit cannot be negative\n"
            "b.yaml:5:128: error: expected a plain number, got '2 m'\n");
}
TEST(LoaderTask, GainsMayBeParametersOrExpressions) {
  const std::string parameters =
      "parameters: {k: {value: 100, range: [0, 300], live: true}, v: {value: [1, 2]}}\n";
  const auto b =
      load(with("{f: {type: com_position, axes: [x, z], reference: 0, "
                "gains: {kp: $k, kd: \"= 2*sqrt($k)\", ki: [$v.x, 3]}}}",
                parameters));
  EXPECT_EQ(b->axes[0].kp, -1);
  EXPECT_GE(b->axes[0].computed[0], 0);
  EXPECT_EQ(b->find_parameter("gains..f.kp"), -1);
  for (const auto& parameter : b->parameters) EXPECT_FALSE(parameter.gain) << parameter.name;
  EXPECT_EQ(behaviors::evaluate(b->expressions, b->axes[1].computed[1], {}), 3.0);
}
TEST(LoaderTask, GainsThatAreExpressionsHaveTheirDimensionAndRange) {
  EXPECT_EQ(problems(with("{f: {type: com_position, axes: [z], reference: 0, "
                          "gains: {kp: $k, kd: \"= 3 m\"}}}",
                          "parameters: {k: {value: 3 m}}\n")),
            "b.yaml:6:72: error: expected a value in 1/s^2, got a length\n"
            "b.yaml:6:83: error: expected a rate (1/s), got a length\n");
  EXPECT_EQ(problems(with("{f: {type: com_position, axes: [z], reference: 0, "
                          "gains: {kp: \"= 1 - 3\"}}}")),
            "b.yaml:5:72: error: '= 1 - 3' is -2: a gain is at least 0\n");
}
TEST(LoaderTask, AStatesGainsGoOverTheStacksKeyByKey) {
  const auto b = load(
      "behavior: 1\nrobot: hume\n"
      "gains: {g: {h: {kp: 270, ki: 20, kd: 10}}}\n"
      "stacks: {s: {gains: g, tasks: {h: {type: com_position, axes: [z], reference: 0}}}}\n"
      "machine:\n  stack: s\n  states:\n    a: {after: 1 s, to: b}\n"
      "    b: {gains: {h: {kp: 300}}, after: 1 s, to: c}\n"
      "    c: {tasks: {h: {gains: {kd: 5}}}}\n");
  ASSERT_EQ(b->controls.size(), 3u);
  const auto gains = [&](std::size_t control) {
    const auto& task = b->tasks[static_cast<std::size_t>(b->controls[control].tasks.first)];
    const auto& axis = b->axes[static_cast<std::size_t>(task.axes.first)];
    const auto value = [&](int slot) { return b->values[static_cast<std::size_t>(slot)]; };
    return std::vector<double>{value(axis.kp), value(axis.ki), value(axis.kd)};
  };
  EXPECT_EQ(gains(0), (std::vector<double>{270, 20, 10}));
  EXPECT_EQ(gains(1), (std::vector<double>{300, 20, 10}));
  EXPECT_EQ(gains(2), (std::vector<double>{270, 20, 5}));
}
TEST(LoaderTask, TrajectoriesHaveTheKeysOfTheirShape) {
  EXPECT_EQ(problems(moving("{trajectory: ellipse, period: 1 s}")),
            "b.yaml:6:16: error: an ellipse needs `radius` and `period`\n");
  EXPECT_EQ(problems(moving("{trajectory: cosine, to: 1 m, over: 1 s, radius: 1 m}")),
            "b.yaml:6:65: error: only an ellipse has `radius`, `period`, `phase`, `direction` and "
            "`ramp`\n");
  EXPECT_EQ(problems(moving("{trajectory: waypoints, to: 1 m, points: [{at: 1 s, to: 1 m}]}")),
            "b.yaml:6:44: error: each of the `points` has its own `to`\n");
  EXPECT_EQ(
      problems(moving("{trajectory: surface}")),
      "b.yaml:6:29: error: the surface is a height of the world: it goes with `axes: [z]` and "
      "`frame: world` of a position\n");
  EXPECT_EQ(
      problems(moving("{trajectory: ellipse, radius: 1 s, period: 0 s, ramp: 1 s, over: 1 s}")),
      "b.yaml:6:16: error: a trajectory needs `to` and `over`\n"
      "b.yaml:6:46: error: expected a length, got '1 s'\n"
      "b.yaml:6:59: error: expected a time above 0 s\n");
}
TEST(LoaderTask, WaypointsComeOneAfterTheOther) {
  EXPECT_EQ(
      problems(moving("{trajectory: waypoints, points: [{at: 1 s, to: 1 m}, {at: 1 s, to: 0 m}, "
                      "{to: 1 m}]}")),
      "b.yaml:6:69: error: this point comes at 1 s, not after the one before (1 s)\n"
      "b.yaml:6:89: error: a point needs `at` (a time since entry) or `over` (since the point "
      "before)\n");
  EXPECT_EQ(problems(moving("{trajectory: waypoints, points: [{at: 50 %, to: 1 m}]}")),
            "b.yaml:6:54: error: '50 %' of what? The trajectory has no `over`\n");
}
TEST(LoaderTask, BetweenAllIsEveryPairThatHasNoForceOfItsOwn) {
  const auto b = load(
      "behavior: 1\nrobot: hume\nmachine:\n  internal: {spread: {between: all, reference: 10 N}}\n"
      "  states:\n    a: {contacts: [right_foot, left_foot], after: 1 s, to: b}\n"
      "    b: {contacts: [right_foot], after: 1 s, to: c}\n"
      "    c: {contacts: [right_foot, left_foot], internal: {own: {between: [left_foot, "
      "right_foot], reference: 5 N}}}\n");
  ASSERT_EQ(b->controls.size(), 3u);
  EXPECT_EQ(b->controls[0].internals.count, 1);
  EXPECT_EQ(b->controls[1].internals.count, 0);
  ASSERT_EQ(b->controls[2].internals.count, 1);
  const auto& own = b->internals[static_cast<std::size_t>(b->controls[2].internals.first)];
  EXPECT_EQ(b->internal_instances[static_cast<std::size_t>(own.instance)], "own");
}
TEST(LoaderTask, AForceThatActsInOneOfItsStatesIsGoodAndOneThatNeverDoesIsAnError) {
  const auto text = [](const std::string& contacts_of_b) {
    return "behavior: 1\nrobot: hume\nmachine:\n  internal: {t: {between: [right_foot, left_foot], "
           "reference: 10 N}}\n  states:\n    a: {contacts: [right_foot], after: 1 s, to: b}\n"
           "    b: {contacts: [" +
           contacts_of_b + "], after: 1 s, to: a}\n";
  };
  EXPECT_EQ(problems(text("right_foot, left_foot")), "");
  EXPECT_EQ(
      problems(text("left_foot")),
      "b.yaml:4:27: error: internal force 't' never acts: no state with it has all of its feet in "
      "contact\n");
}
TEST(LoaderTask, AGainThatEveryTaskReplacesIsUnusedAndOneThatSomeTaskTakesIsNot) {
  const auto text = [](const std::string& of_b) {
    const std::string task = "rest: {type: joint_damping, priority: 1, gains: {kd: 3}}";
    return "behavior: 1\nrobot: hume\ngains: {t: {rest: {kd: 2}}}\nmachine:\n  contacts: []\n"
           "  gains: t\n  states:\n    a: {tasks: {" +
           task + "}, after: 1 s, to: b}\n    b: {tasks: {" + (of_b.empty() ? task : of_b) +
           "}, after: 1 s, to: a}\n";
  };
  EXPECT_EQ(problems(text("rest: {type: joint_damping, priority: 1}")), "");
  EXPECT_EQ(problems(text("")),
            "b.yaml:3:24: warning: no task uses gains.t.rest.kd: the value at b.yaml:8:70 takes "
            "precedence\n");
}
TEST(LoaderTask, APairHasOneForce) {
  EXPECT_EQ(problems("behavior: 1\nrobot: hume\nmachine:\n  contacts: [right_foot, left_foot]\n"
                     "  internal:\n    a: {between: [right_foot, left_foot], reference: 1 N}\n"
                     "    b: {between: [left_foot, right_foot], reference: 1 N}\n"
                     "    c: {between: [left_foot, left_foot], reference: 1 N}\n"),
            "b.yaml:7:18: error: another internal force acts between these contacts already\n"
            "b.yaml:8:30: error: an internal force acts between two feet, not one\n");
}
TEST(LoaderTask, RegionsThatContradictEachOtherAreErrors) {
  const std::string text =
      "behavior: 1\nrobot: hume\ntorque_loop: {t: {p: 1}}\nmachine:\n  type: parallel\n"
      "  tasks: {k: {type: joint_damping, gains: {kd: 1}}}\n  states:\n"
      "    l: {contacts: [right_foot, left_foot], gains: {k: {kd: 2}}, torque_loop: {left_leg: "
      "t}}\n"
      "    r: {contacts: [left_foot, right_foot], gains: {k: {kd: 3}}, torque_loop: {left_leg: "
      "t}}\n";
  EXPECT_EQ(problems(text),
            "b.yaml:9:52: error: gains of 'k' is given by 'l' and by 'r' at once\n"
            "b.yaml:9:79: error: torque_loop 'left_leg' is given by 'l' and by 'r' at once\n");
}
TEST(LoaderTask, TorqueLoopsGoByExactNameThenByGlobAndOnceAJoint) {
  const auto b = load(
      "behavior: 1\nrobot: hume\n"
      "torque_loop: {t: {p: {\"*\": 1, left_hip: 2}}}\nmachine: {}\n");
  const auto joint = [&](const char* name) {
    return b
        ->values[static_cast<std::size_t>(b->torque_loops[0].slots[0] + b->robot.find_joint(name))];
  };
  EXPECT_EQ(joint("left_hip"), 2.0);
  EXPECT_EQ(joint("right_hip"), 1.0);
  EXPECT_EQ(problems("behavior: 1\nrobot: hume\n"
                     "torque_loop: {t: {p: {\"*_hip\": 1, \"left_*\": 2}}}\nmachine: {}\n")
                .find("b.yaml:3:35: error: "),
            0u);
  EXPECT_EQ(problems("behavior: 1\nrobot: hume\ntorque_loop: {t: {p: 1}}\n"
                     "machine: {torque_loop: {right_foot: t, right_leg: t}}\n"),
            "b.yaml:4:40: error: 'right_foot' and 'right_leg' both give joint 'right_abduction' a "
            "torque_loop\n");
}
TEST(LoaderTask, OffTakesATorqueLoopAway) {
  const auto b = load(
      "behavior: 1\nrobot: hume\ntorque_loop: {t: {p: 1}}\nmachine:\n"
      "  torque_loop: {right_leg: t}\n  states: {a: {torque_loop: {right_leg: off}}}\n");
  const auto joint = static_cast<std::size_t>(b->robot.find_joint("right_hip"));
  EXPECT_EQ(b->controls[0].torque_loops[joint], -1);
}
TEST(LoaderTask, RegionsThatSayNothingDoNotMultiply) {
  // Five regions of twelve states, one of which controls: 2^5 combinations, not 12^5.
  std::string text = "behavior: 1\nrobot: hume\nmachine:\n  type: parallel\n  states:\n";
  for (int r = 0; r < 5; ++r) {
    const std::string region = "r" + std::to_string(r);
    text += "    " + region + ":\n      states:\n";
    for (int s = 0; s < 12; ++s) {
      text += "        s" + std::to_string(s) + ": {" +
              (s == 7 ? "tasks: {" + region + ": {type: joint_damping, gains: {kd: 1}}}" : "") +
              "}\n";
    }
  }
  const auto b = load(text);
  EXPECT_EQ(b->controls.size(), 32u);
  int all = 0;
  for (int r = 0; r < 5; ++r) {
    const int s = b->find_state("r" + std::to_string(r) + ".s7");
    all += b->states[static_cast<std::size_t>(s)].control_weight;
  }
  EXPECT_EQ(b->controls[static_cast<std::size_t>(all)].tasks.count, 5);
  EXPECT_EQ(b->controls[0].tasks.count, 0);
}

}  // namespace
}  // namespace footfall::tests
