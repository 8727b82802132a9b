// Internal forces, references and torque steps as the checks judge them. Oracles: statics of two
// feet by hand. Equations: [Kim16] eqs. (7)-(10) with E10.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "behaviors/check/physics/law.h"
#include "behaviors/check/physics/postures.h"
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
  model.update(behaviors::physics_postures(b->robot, model, {}).front());
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

// A V of 45 deg under the feet, which stand beside each other: faces fall towards the middle.
model::Terrain valley() {
  const double c = std::sqrt(0.5);
  model::Terrain terrain;
  for (const double side : {-1.0, 1.0}) {
    // Turned about x; its face through (0, side 0.5, 0.5), that is through the x axis.
    model::TerrainPiece box = {{0.0, side * (0.5 + 0.2 * c), 0.5 - 0.2 * c},
                               {1, 0, 0, 0, c, -side * c, 0, side * c, c},
                               {1.0, 0.7, 0.2}};
    terrain.boxes.push_back(box);
  }
  return terrain;
}

// By hand: with half the weight W on each foot and a tension T the ground pushes a foot with W up
// and T inwards, (W - T)/sqrt 2 along a face of 45 deg and (W + T)/sqrt 2 into it. With mu = 0.9
// it stands from T = W/19 on.
TEST(PhysicsForces, OnSlopesTheConeIsAboutTheirNormals) {
  const auto judge = [](const std::string& tension) {
    core::Diagnostics diagnostics, findings;
    const auto behavior = behaviors::load_behavior_text(squeezing(tension), "b.yaml",
                                                        options_for_tests(), diagnostics);
    for (int f = 0; f < diagnostics.file_count(); ++f) findings.add_file(diagnostics.file(f));
    behaviors::check_physics(*behavior, findings, {.terrain = valley()});
    return findings.to_string();
  };
  EXPECT_THAT(judge("3 N"), HasSubstr("with internal force 'tension' of 3 N at each foot the robot "
                                      "cannot stand where the world starts it, "));
  EXPECT_THAT(judge("3 N"), HasSubstr("would slip: 67 N along the ground, at most 0.9 x 7"));
  EXPECT_THAT(judge("50 N"), testing::Not(HasSubstr("error")));
  EXPECT_THAT(judge("98 N"), testing::Not(HasSubstr("error")));  // no friction needed
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

// Oracle: balance_best lifts its feet by 60 cm and does not fall; hips 0.96 m high, and legs that
// fold to above them, cannot bring a foot to 1.5 m while the torso is upright.
TEST(PhysicsReach, AFootThatIsLiftedHigherThanTheLegsAllowIsRefused) {
  const auto lifted = [](const std::string& by) {
    return standing("[right_foot]",
                    height() + attitude("[pitch, roll]") +
                        "      swing: {type: point_position, point: left_foot, axes: [z], gains: "
                        "{kp: 1}, reference: {trajectory: minimum_jerk, to: \"= entry + " +
                        by + "\", over: 1 s}}\n" + rest());
  };
  EXPECT_EQ(physics(lifted("6 cm")), "");
  EXPECT_EQ(physics(lifted("60 cm")), "");
  EXPECT_THAT(physics(lifted("1.5 m")),
              HasSubstr("error: task 'swing' asks for a foot at a height of 1.5 m: on right_foot "
                        "alone it can be 1.4"));
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
