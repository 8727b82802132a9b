// What only one of simulator and control model knows is told at its line and column, and what both
// know is not. tools/acceptance.d/silent/models.py has more of the kind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "model/check/check.h"
#include "model/control_model.h"

namespace footfall::tests {
namespace {

using testing::HasSubstr;

// One leg, a ball for a foot. Line 3 has the defaults, 7 the joint, 11 the motor.
constexpr std::string_view kHopper = R"(<mujoco>
<default>
<joint limited="true" range="-58 58"/>
<default class="stiff"><joint stiffness="7"/></default>
</default>
<worldbody><body name="torso"><freejoint/><geom size=".1"/><body name="leg">
<joint name="hip" axis="0 1 0"/>
<geom size=".05" pos="0 0 -1"/><site name="foot" pos="0 0 -1"/>
</body></body></worldbody>
<actuator>
<motor joint="hip"/>
</actuator></mujoco>
)";

class ModelCheck : public testing::Test {
 protected:
  ModelCheck()
      : folder_(std::filesystem::path(testing::TempDir()) /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
    robot_.path = "robot.yaml";
    robot_.model_path = (folder_ / "hopper.xml").string();
    robot_.floating_base = "torso";
    robot_.joints.resize(1);
    robot_.joints[0] = {"hip", -1.0, 1.0, 60.0, 0.0, 0.0, 0.0};
    robot_.contacts.resize(1);
    robot_.contacts[0].name = robot_.contacts[0].site = "foot";
    robot_.contacts[0].radius = 0.05;
  }
  ~ModelCheck() override { std::filesystem::remove_all(folder_); }

  // The problems of the hopper with `from` replaced by `to`, without the folder.
  std::string problems(std::string_view from, std::string_view to) {
    std::string text(kHopper);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(robot_.model_path) << text.replace(at, from.size(), to);
    core::Diagnostics diagnostics;
    model::check_model(robot_, diagnostics);
    std::string out = diagnostics.to_string();
    const std::string folder = folder_.string() + "/";
    for (std::size_t i = out.find(folder); i != std::string::npos; i = out.find(folder)) {
      out.erase(i, folder.size());
    }
    return out;
  }

  std::filesystem::path folder_;
  model::RobotDescription robot_;
};

TEST_F(ModelCheck, AModelThatBothKnowIsNotTold) {
  EXPECT_EQ(problems("", ""), "");
  EXPECT_EQ(problems("axis", "armature=\"0.1\" axis"), "");  // in the mass matrix of both
  EXPECT_EQ(problems("<geom size=\".05\"", "<geom size=\".05\" friction=\"3\""),
            "");  // the world's
}

TEST_F(ModelCheck, AnActuatorThatTakesNoTorqueIsRefused) {
  EXPECT_THAT(problems("<motor", "<position kp=\"100\""),
              HasSubstr("hopper.xml:11:1: error: the actuator of joint 'hip' is no plain motor"));
  EXPECT_THAT(problems("<motor joint=\"hip\"/>", "<motor joint=\"hip\"/><velocity joint=\"hip\"/>"),
              HasSubstr("hopper.xml:11:21: error: joint 'hip' has a second actuator"));
}

TEST_F(ModelCheck, AnActuatorThatScalesOrCutsTheTorqueIsRefusedWhereItSaysSo) {
  EXPECT_THAT(problems("<motor", "<motor gear=\"3\""),
              HasSubstr("hopper.xml:11:8: error: the actuator of joint 'hip' has gear 3"));
  EXPECT_THAT(problems("<motor", "<motor ctrllimited=\"true\" ctrlrange=\"-60 59\""),
              HasSubstr("hopper.xml:11:27: error: the actuator of joint 'hip' is limited to -60"));
  EXPECT_EQ(problems("<motor", "<motor ctrllimited=\"true\" ctrlrange=\"-60 60\""), "");
}

TEST_F(ModelCheck, ADefaultIsToldWhereItIsWritten) {
  EXPECT_THAT(problems("<joint limited", "<joint damping=\"2\" limited"),
              HasSubstr("hopper.xml:3:8: warning: joint 'hip' has damping 2"));
  EXPECT_THAT(problems("name=\"hip\"", "name=\"hip\" class=\"stiff\""),
              HasSubstr("hopper.xml:4:31: warning: joint 'hip' has a spring of stiffness 7"));
}

TEST_F(ModelCheck, AnIncludedFileIsToldAsItself) {
  std::ofstream(folder_ / "more.xml") << "<mujoco>\n <option timestep=\"0.01\"/></mujoco>";
  const std::string path = (folder_ / "more.xml").string();
  EXPECT_THAT(problems("<default>", "<include file=\"" + path + "\"/><default>"),
              HasSubstr("more.xml:2:10: warning: <option timestep=\"0.01\"> of the robot's model"));
}

TEST_F(ModelCheck, TheMassOfAShapeThatPhysicsLeavesOutIsNotLostInSilence) {
  const std::string seen = "<geom size=\".1\" mass=\"3\" contype=\"0\" conaffinity=\"0\"/>";
  EXPECT_THAT(problems("<geom size=\".1\"/>", "<geom size=\".1\"/>" + seen),
              HasSubstr("hopper.xml:6:60: error: 3 kg of body 'torso' are lost"));
  // With an inertia of its own the body does not count its shapes.
  EXPECT_EQ(problems("<geom size=\".1\"/>",
                     "<inertial mass=\"5\" pos=\"0 0 0\" diaginertia=\"1 1 1\"/>" + seen),
            "");
}

TEST_F(ModelCheck, ABaseThatIsNotUprightIsRefusedAndOneThatLooksAsideIsTold) {
  EXPECT_THAT(problems("name=\"torso\"", "name=\"torso\" quat=\"0.7071 0.7071 0 0\""),
              HasSubstr("hopper.xml:6:31: error: the floating base 'torso' is tilted by 90 deg"));
  EXPECT_THAT(
      problems("name=\"torso\"", "name=\"torso\" quat=\"0 0 0 1\""),
      HasSubstr("hopper.xml:6:31: warning: the floating base 'torso' is turned by 180 deg"));
}

TEST_F(ModelCheck, WhatTheWorldHasIsRefused) {
  EXPECT_THAT(problems("<worldbody>", "<worldbody><geom type=\"plane\" size=\"1 1 1\"/>"),
              HasSubstr("hopper.xml:6:12: error: the model brings a floor"));
  EXPECT_THAT(problems("<geom size=\".1\"/>", "<geom name=\"ground\" size=\".1\"/>"),
              HasSubstr("error: the name 'ground' is that of a shape of the world"));
  EXPECT_THAT(problems("<worldbody>", "<worldbody><body mocap=\"true\"/>"),
              HasSubstr("hopper.xml:6:12: error: body number 2 is moved from outside (mocap)"));
}

TEST_F(ModelCheck, AFootThatDoesNotMeetTheGroundAsTheWorldSaysIsRefused) {
  EXPECT_THAT(problems("<geom size=\".05\"", "<geom contype=\"2\" conaffinity=\"4\" size=\".05\""),
              HasSubstr("hopper.xml:8:7: error: the ball of contact 'foot' falls through"));
  EXPECT_THAT(problems("<geom size=\".05\"", "<geom priority=\"1\" size=\".05\""),
              HasSubstr("hopper.xml:8:7: error: geom number 2 has priority 1"));
  EXPECT_THAT(
      problems("<geom size=\".05\"", "<geom size=\".04\""),
      HasSubstr("hopper.xml:8:7: warning: the ball of contact 'foot' has a radius of 40 mm"));
  EXPECT_THAT(problems("<actuator>",
                       "<contact><exclude body1=\"world\" body2=\"leg\"/></contact>"
                       "<actuator>"),
              HasSubstr("hopper.xml:10:10: error: a body that is excluded"));
}

TEST_F(ModelCheck, AnAttributeThatMuJoCoDoesNotKnowIsRefusedAtItsPlace) {
  EXPECT_THAT(problems("<body name=\"leg\"", "<body gravcomp=\"1\" name=\"leg\""),
              HasSubstr("hopper.xml:6:66: error: MuJoCo refuses it"));
}

}  // namespace
}  // namespace footfall::tests
