// Internal forces, references, planners and torque steps as the checks judge them. Oracles: statics
// of two feet by hand, the pendulum's step-to-step map as a matrix. Equations: [Kim16] eqs.
// (7)-(10) with E10, eqs. (19), (21) with E1.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <filesystem>

#include "behaviors/check/physics/law.h"
#include "behaviors/check/physics/postures.h"
#include "behaviors/machine/planner_calls.h"
#include "tests/unit/behaviors/check/physics_test_support.h"

namespace footfall::tests {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string squeezing(const std::string& reference, const std::string& parameters = "") {
  return standing("[right_foot, left_foot]", dual_tasks(),
                  "    internal: {tension: {between: [right_foot, left_foot], reference: " +
                      reference + "}}\n" + parameters);
}

// At the nominal posture the centre of mass is over the middle of the feet, which stand beside each
// other: each carries half of the weight, and the internal force is all that pushes sideways.
TEST(PhysicsForces, TheLawAtRestCarriesHalfTheWeightOnEachFoot) {
  const auto b = load(squeezing("20 N"));
  model::ControlModel model(b->robot);
  behaviors::PhysicsLaw law(*b, model);
  model.update(behaviors::physics_postures(b->robot).front());
  const auto rest = law.rest(b->controls.front(), {20.0});
  const double half = 0.5 * model.mass() * model.gravity();
  for (std::size_t foot = 0; foot < 2; ++foot) {
    EXPECT_NEAR(rest.forces[foot][2], half, 0.01 * half);  // posture given to 1e-5 deg, CoM to 1 mm
    EXPECT_NEAR(rest.forces[foot][1], foot == 0 ? 20.0 : -20.0, 1e-6);  // ground on robot: inwards
  }
}

TEST(PhysicsForces, AnInternalForceBeyondFrictionIsRefusedAtItsReference) {
  const auto b = load(squeezing("20 N"));
  const model::ControlModel model(b->robot);
  const double limit = 0.9 * 0.5 * model.mass() * model.gravity();  // by hand, as above
  EXPECT_GT(100.0, limit);  // the paper's 100 N a foot need a valley
  const std::string text = squeezing("100 N");
  EXPECT_THAT(
      physics(text),
      StartsWith(place_of(text, "100 N") +
                 "error: internal force 'tension' of 100 N at each foot leaves the friction "
                 "cone: standing still, "));
  EXPECT_THAT(physics(text), HasSubstr("would slip: 100 N along the ground, at most 0.9 x "));
  EXPECT_EQ(physics(squeezing("20 N")), "");
  EXPECT_THAT(physics(squeezing("-100 N")), HasSubstr("error: internal force"));
}

TEST(PhysicsForces, TheSumConventionCountsBothFeet) {
  EXPECT_EQ(physics(squeezing("40 N, convention: sum")), "");
  EXPECT_THAT(physics(squeezing("200 N, convention: sum")), HasSubstr("of 100 N at each foot"));
}

TEST(PhysicsForces, AnEditAtTheEndOfItsRangeIsWarnedAbout) {
  const std::string text = "parameters: {push: {value: 20 N, range: [0 N, 200 N], live: true}}\n";
  const std::string said = physics(squeezing("$push", text));
  EXPECT_THAT(said, HasSubstr("warning: internal force 'tension' of 200 N at each foot leaves the "
                              "friction cone at the end of the range of 'push'"));
  EXPECT_THAT(said, testing::Not(HasSubstr("error")));
}

TEST(PhysicsForces, FrictionIsTheRobotFiles) {
  const std::string folder = testing::TempDir();
  const auto slippery = with_contacts(folder, "{site: right_foot, radius: 25 mm, friction: 0.1}",
                                      "{site: left_foot, radius: 25 mm, friction: 0.1}");
  EXPECT_THAT(physics(squeezing("20 N"), slippery), HasSubstr("at most 0.1 x "));
}

// At 98 N on each foot, 32 N need a friction of 0.327.
TEST(PhysicsForces, TheWorldsFrictionCountsWhereItIsLess) {
  const auto judge = [](std::optional<double> friction) {
    core::Diagnostics diagnostics, findings;
    const auto behavior = behaviors::load_behavior_text(squeezing("32 N"), "b.yaml",
                                                        options_for_tests(), diagnostics);
    for (int f = 0; f < diagnostics.file_count(); ++f) findings.add_file(diagnostics.file(f));
    behaviors::check_physics(*behavior, findings, {.friction = friction});
    return findings.to_string();
  };
  EXPECT_EQ(judge(std::nullopt), "");
  EXPECT_EQ(judge(0.9), "");
  EXPECT_EQ(judge(2.0), "");
  EXPECT_THAT(judge(0.3),
              HasSubstr("error: internal force 'tension' of 32 N at each foot leaves the "
                        "friction cone: standing still, "));
  EXPECT_THAT(judge(0.3), HasSubstr("at most 0.3 x 98 N = 29 N (friction of the world)"));
}

TEST(PhysicsContacts, SurfacesAreRefusedByName) {
  const auto flat = with_contacts(testing::TempDir(), "{site: right_foot, type: surface}",
                                  "{site: left_foot, type: fixed}");
  const std::string said = physics(standing("[right_foot, left_foot]", dual_tasks()), flat);
  EXPECT_THAT(said, HasSubstr("other.yaml:4:40: error: contact 'right_foot' is of type 'surface', "
                              "which is not available in this version"));
  EXPECT_THAT(said, HasSubstr("contact 'left_foot' is of type 'fixed'"));
}

// --- references

std::string height_of(const std::string& reference) {
  return standing("[right_foot, left_foot]",
                  "      height: {type: com_position, axes: [z], reference: " + reference +
                      ", gains: {kp: 1}}\n" + attitude("[yaw, pitch, roll]") + rest());
}

TEST(PhysicsReach, AHeightThatNoLegAllowsIsRefused) {
  const std::string text = height_of("9.1 m");
  EXPECT_THAT(physics(text), StartsWith(place_of(text, "9.1 m") +
                                        "error: task 'height' asks for a centre of mass at a "
                                        "height of 9.1 m: on right_foot and left_foot it can be "));
  EXPECT_THAT(physics(height_of("\"= entry + 60 m\"")), HasSubstr("error: task 'height'"));
  EXPECT_THAT(physics(height_of("-0.9 m")), HasSubstr("that is in the ground"));
}

// Straight legs carry the hips 0.95785 m above the ground (robots/hume/hume.xml), the centre of
// mass higher still: up to there nothing may be refused.
TEST(PhysicsReach, WhatStraightLegsReachIsNotRefused) {
  EXPECT_EQ(physics(height_of("0.91 m")), "");
  EXPECT_EQ(physics(height_of("1.0 m")), "");
  EXPECT_EQ(physics(height_of("\"= entry + 6 cm\"")), "");
  EXPECT_EQ(physics(height_of("{trajectory: minimum_jerk, to: \"= entry - 3 cm\", over: 1 s}")),
            "");
}

// Hume's base must stay above 60 % of 0.84 m; its CoM is some centimetres above the base. Oracle:
// the base of a crouch whose CoM is there.
TEST(PhysicsReach, AHeightAtWhichItCountsAsFallenIsRefused) {
  const auto at_height = [](const std::string& reference) {
    return standing("[right_foot, left_foot]",
                    "      height: {type: com_position, axes: [z], reference: " + reference +
                        ", gains: {kp: 100, kd: 20}}\n" + attitude("[yaw, pitch, roll]") + rest());
  };
  const std::string text = at_height("0.45 m");
  EXPECT_THAT(physics(text),
              StartsWith(place_of(text, "0.45 m") +
                         "error: task 'height' asks for a centre of mass at a height "
                         "of 0.45 m: the base is then 0."));
  EXPECT_THAT(physics(text),
              HasSubstr("m above the ground at most, and below 0.504 m (limits.height "
                        "of the robot) it counts as fallen"));
  EXPECT_EQ(physics(at_height("0.65 m")), "");
  EXPECT_THAT(physics(at_height("{trajectory: minimum_jerk, to: 0.4 m, over: 1 s}")),
              HasSubstr("it counts as fallen"));
  EXPECT_THAT(physics(at_height("{trajectory: waypoints, over: 2 s, points: [{at: 1 s, to: 0.4 m}, "
                                "{at: 2 s, to: 0.8 m}]}")),
              HasSubstr("it counts as fallen"));
  const std::string hips =
      "      hips: {type: point_position, point: hip_center, axes: [z], reference: 0.5 m, gains: "
      "{kp: 100, kd: 20}}\n";
  EXPECT_THAT(
      physics(standing("[right_foot, left_foot]", hips + attitude("[yaw, pitch, roll]") + rest())),
      HasSubstr("the base is then 0.5 m above the ground at most"));
}

TEST(PhysicsReach, JointsHaveLimitsAndTheBodyMayNotTiltAsIfFallen) {
  const std::string knee =
      "      knee: {type: joint_posture, joints: [left_knee], priority: 2, reference: 210 deg, "
      "gains: "
      "{kp: 1}}\n";
  const std::string text = standing("[right_foot, left_foot]", dual_tasks() + knee);
  EXPECT_THAT(physics(text),
              StartsWith(place_of(text, "210 deg") +
                         "error: task 'knee' asks for 210 deg of 'left_knee', whose limits are -20 "
                         "to 200 deg"));
  const std::string tilt =
      "      lean: {type: body_orientation, axes: [roll], reference: 1 rad, gains: {kp: 1}}\n";
  EXPECT_THAT(physics(standing("[right_foot, left_foot]", height() + tilt + rest())),
              HasSubstr("error: task 'lean' asks for roll 57.3 deg"));
}

// --- planners

std::string walking(const std::string& kappa, const std::string& parameters = "") {
  return "behavior: 1\nrobot: hume\n" + parameters +
         "planners: {foot: {type: velocity_reversal, kappa: " + kappa +
         ", reversal: 185 ms}}\n"
         "stacks:\n  single:\n    contacts: [right_foot]\n    tasks:\n"
         "      height: {type: com_position, axes: [z], reference: 0.935 m, gains: {kp: 1}}\n" +
         attitude("[pitch, roll]") + swing() + R"(machine:
  stack: single
  states:
    ready: {after: 40 ms, to: lift}
    lift:
      invoke: [{planner: foot, with: {stance: right_foot, swing: left_foot, switch_in: "= 295 ms - t"}}]
      after: 295 ms
      to: ready
)";
}

double printed_eigenvalue(const std::string& text) {
  const std::string before = " is ";
  const std::size_t found = text.find(before, text.find("an eigenvalue"));
  return found == std::string::npos ? 0.0 : std::stod(text.substr(found + before.size()));
}

// About the goal, from switch to switch: the foot goes to x_p = (1 + k) x + coth(w t')/w v, then
// the pendulum moves for T about it.
double largest_eigenvalue(double kappa, double reversal, double height, double T) {
  const double w = std::sqrt(9.81 / height);
  const double C = std::cosh(w * T), S = std::sinh(w * T);
  // M = [C, S/w; wS, C] + B K, column by row.
  const double B[2] = {1.0 - C, -w * S};
  const double K[2] = {1.0 + kappa, 1.0 / (w * std::tanh(w * reversal))};
  const double trace = 2.0 * C + B[0] * K[0] + B[1] * K[1];
  const double determinant =
      (C + B[0] * K[0]) * (C + B[1] * K[1]) - (S / w + B[0] * K[1]) * (w * S + B[1] * K[0]);
  const std::complex<double> root =
      std::sqrt(std::complex<double>(trace * trace - 4.0 * determinant));
  return std::max(std::abs(trace + root), std::abs(trace - root)) / 2.0;
}

TEST(PhysicsPlanner, ThePrintedSignOfKappaIsRejectedWithItsEigenvalue) {
  const std::string text = walking("{value: -0.4, range: [-1, 1]}");
  const std::string said = physics(text);
  EXPECT_THAT(said,
              StartsWith(place_of(text, "{value: -0.4") + "error: planner 'foot' diverges: "));
  EXPECT_THAT(said, HasSubstr("height h 0.935 m, step time T 0.335 s"));
  EXPECT_NEAR(printed_eigenvalue(said), 1.28, 0.01);  // the bar
  EXPECT_NEAR(printed_eigenvalue(said), largest_eigenvalue(-0.4, 0.185, 0.935, 0.335), 5e-4);
}

TEST(PhysicsPlanner, TheCorrectedSignIsClean) {
  EXPECT_LT(largest_eigenvalue(0.4, 0.185, 0.935, 0.335), 1.0);
  EXPECT_EQ(physics(walking("0.4")), "");
  EXPECT_EQ(physics(walking("0")), "");  // steps drift, they do not grow
}

// kappa 0.9, reversal 500 ms, 540 ms a step: a conjugate pair, which the real parts hide.
TEST(PhysicsPlanner, AComplexPairIsJudgedByItsModulus) {
  std::string text = walking("0.9");
  const auto replace = [&text](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1)) {
      text.replace(at, from.size(), to);
    }
  };
  replace("185 ms", "500 ms");
  replace("295 ms", "500 ms");
  const std::string said = physics(text);
  EXPECT_THAT(said, HasSubstr("error: planner 'foot' diverges: an eigenvalue of its step-to-step "
                              "map in x is "));
  EXPECT_THAT(said, HasSubstr(fmt::format("i, of modulus {:.3f} (kappa 0.9, reversal 500 ms",
                                          largest_eigenvalue(0.9, 0.5, 0.935, 0.54))));
  EXPECT_THAT(said, HasSubstr("its modulus must not exceed 1; here kappa must be below 0."));
}

// The longer of two strides, each at a height of its own, is not always the less stable one.
TEST(PhysicsPlanner, EveryStrideIsJudgedAtItsOwnHeight) {
  const std::string low =
      R"(    low:
      tasks: {height: {type: com_position, axes: [z], reference: 0.5 m, gains: {kp: 1}}}
      invoke: [{planner: foot, with: {stance: right_foot, swing: left_foot, switch_in: "= 320 ms - t"}}]
      after: 320 ms
      to: ready
)";
  std::string text = walking("0.9");
  text.replace(text.find("185 ms"), 6, "350 ms");
  EXPECT_LT(largest_eigenvalue(0.9, 0.35, 0.935, 0.335), 1.0);
  EXPECT_GT(largest_eigenvalue(0.9, 0.35, 0.5, 0.32), 1.0);
  EXPECT_EQ(physics(text), "");
  EXPECT_THAT(physics(text + low), HasSubstr("error: planner 'foot' diverges"));
}

TEST(PhysicsPlanner, ANegativeKappaNeedsARangeThatAllowsIt) {
  EXPECT_THAT(problems(walking("-0.4")), HasSubstr("error: kappa -0.4 is outside 0 .. 1"));
  EXPECT_THAT(problems(walking("$k", "parameters: {k: -0.4}\n")), HasSubstr("is outside 0 .. 1"));
  const std::string wide = "parameters: {k: {value: [-0.4, -0.4], range: [-1, 1]}}\n";
  EXPECT_EQ(problems(walking("$k", wide)).find(": error: "), std::string::npos);
  EXPECT_THAT(physics(walking("$k", wide)), HasSubstr("error: planner 'foot' diverges"));
}

TEST(PhysicsPlanner, ALiveKappaIsReadWhenThePlannerIsAskedAndWarnedAboutAtItsEnds) {
  const std::string live = "parameters: {k: {value: 0.4, range: [-1, 1], live: true}}\n";
  const std::string text = walking("$k", live);
  EXPECT_THAT(physics(text), HasSubstr("warning: planner 'foot' diverges at the end of the range "
                                       "of 'k'"));
  const auto b = load(text);
  std::vector<double> values = b->values;
  EXPECT_EQ(behaviors::spec_in_force(b->planners[0], values).kappa[1], 0.4);
  values[static_cast<std::size_t>(b->parameters[0].slot)] = 0.2;
  EXPECT_EQ(behaviors::spec_in_force(b->planners[0], values).kappa[1], 0.2);
}

// --- torque steps

std::string two_stances(const std::string& second) {
  return "behavior: 1\nrobot: hume\nstacks:\n"
         "  dual:\n    contacts: [right_foot, left_foot]\n    tasks:\n" +
         dual_tasks() + "  single:\n    contacts: [right_foot]\n    tasks:\n" + single_tasks() +
         "machine:\n  safe: limp\n  states:\n    both: {stack: dual, after: 1 s, to: one}\n" +
         second + "    limp: {tasks: {rest: {type: joint_damping, gains: {kd: 1}}}}\n";
}

TEST(PhysicsSteps, AFootReleasedAtOnceIsWarnedAboutAtTheTransition) {
  const std::string text = two_stances("    one: {stack: single}\n");
  const std::string said = physics(text);
  EXPECT_THAT(said, StartsWith(place_of(text, "1 s") + "warning: the torque of '"));
  EXPECT_THAT(said, HasSubstr("when 'both' is left, from right_foot and left_foot to right_foot "
                              "alone (the robot's bound is 5 Nm): ramp it with a "
                              "contact_transition that releases in the state entered"));
  // docs/acceptance.md, row transitions: 24-28 Nm on Hume without transition.
  const std::size_t by = said.find("steps by ");
  ASSERT_NE(by, std::string::npos);
  EXPECT_NEAR(std::stod(said.substr(by + 9)), 26.0, 2.5);
}

TEST(PhysicsSteps, ADeclaredTransitionIsClean) {
  EXPECT_EQ(
      physics(two_stances(
          "    one: {stack: single, contact_transition: {releases: left_foot, over: 24 ms}}\n")),
      "");
}

TEST(PhysicsSteps, LoadingCoversWhatComesAfterIt) {
  const std::string release = "contact_transition: {releases: left_foot, over: 24 ms}";
  const std::string loads = "    one: {stack: single, " + release +
                            ", after: 1 s, to: load}\n"
                            "    load: {stack: single, contact_transition: {loads: left_foot, "
                            "over: 24 ms, toward: dual}, "
                            "after: 24 ms, to: both}\n";
  EXPECT_EQ(physics(two_stances(loads)), "");
  const std::string at_once = "    one: {stack: single, " + release + ", after: 1 s, to: both}\n";
  EXPECT_THAT(physics(two_stances(at_once)), HasSubstr("that loads in the state left"));
}

// A region beside the stride changes the law while a foot is being loaded: nothing of the feet
// changes by that. The stride's own transitions are judged as ever.
std::string beside_a_nod(const std::string& load, const std::string& after_load) {
  return "behavior: 1\nrobot: hume\nstacks:\n"
         "  dual:\n    contacts: [right_foot, left_foot]\n    tasks:\n" +
         dual_tasks() + "  single:\n    contacts: [right_foot]\n    tasks:\n" + single_tasks() +
         std::string(
             "machine:\n  states:\n    all:\n      type: parallel\n      states:\n"
             "        stride:\n          states:\n"
             "            both: {stack: dual, after: 1 s, to: one}\n"
             "            one: {stack: single, contact_transition: {releases: left_foot, over: 24 "
             "ms}, after: 1 s, to: load}\n") +
         "            load: {stack: single, " + load + "after: 24 ms, to: " + after_load +
         "}\n        nod:\n          states:\n"
         "            down: {tasks: {knee: {type: joint_posture, joints: [left_knee], priority: 3, "
         "reference: 0.1, gains: {kp: 1}}}, after: 70 ms, to: up}\n"
         "            up: {tasks: {knee: {type: joint_posture, joints: [left_knee], priority: 3, "
         "reference: 0, gains: {kp: 1}}}, after: 70 ms, to: down}\n";
}

TEST(PhysicsSteps, OnlyWhereTheOwnerOfTheTransitionIsLeftIsItsLawReached) {
  const std::string load = "contact_transition: {loads: left_foot, over: 24 ms, toward: dual}, ";
  EXPECT_EQ(physics(beside_a_nod(load, "both")), "");
  const std::string without = physics(beside_a_nod("", "both"));
  EXPECT_THAT(without, HasSubstr("that loads in the state left"));
  EXPECT_THAT(without, HasSubstr("when 'all.stride.load' is left"));
  EXPECT_THAT(without, testing::Not(HasSubstr("nod")));
  EXPECT_THAT(physics(beside_a_nod(load, "one")), testing::Not(HasSubstr("nod")));
}

// Nor do transitions between children of the state that declares it.
TEST(PhysicsSteps, ChildrenOfTheStateThatLoadsMayChange) {
  const std::string loads =
      "    one: {stack: single, contact_transition: {releases: left_foot, over: 24 ms}, after: 1 "
      "s, "
      "to: load}\n"
      "    load:\n      stack: single\n      contact_transition: {loads: left_foot, over: 24 ms, "
      "toward: dual}\n      after: 24 ms\n      to: both\n      states:\n"
      "        early: {tasks: {attitude: {reference: 0.1}}, after: 10 ms, to: late}\n"
      "        late: {tasks: {attitude: {reference: 0}}}\n";
  EXPECT_EQ(physics(two_stances(loads)), "");
}

TEST(PhysicsCheck, ABehaviorWithoutARobotHasNoPhysics) {
  EXPECT_EQ(physics("behavior: 1\nmachine: {states: {a: {doc: here}}}\n"), "");
}

}  // namespace
}  // namespace footfall::tests
