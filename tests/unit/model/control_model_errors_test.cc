// What a model that does not fit its robot file is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "model/control_model.h"

namespace footfall::tests {
namespace {

using testing::HasSubstr;

constexpr const char* kBiped = R"(<mujoco><worldbody><body name="torso"><freejoint/>
  <geom size="0.1"/><site name="head"/><body name="leg"><joint name="hip" axis="0 1 0"/>
  <geom size="0.1" pos="0 0 -0.5"/><site name="foot" pos="0 0 -1"/></body></body></worldbody></mujoco>)";

class ModelError : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("footfall_model_") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    robot_.path = "robot.yaml";
    robot_.model_path = (folder_ / "biped.xml").string();
    robot_.floating_base = "torso";
    robot_.joints.resize(1);
    robot_.joints[0].name = "hip";
    robot_.contacts.resize(1);
    robot_.contacts[0].name = robot_.contacts[0].site = "foot";
    write(kBiped);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& xml) { std::ofstream(robot_.model_path) << xml; }
  std::string message() {
    try {
      model::ControlModel model(robot_, deviation_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
  model::RobotDescription robot_;
  model::ModelDeviation deviation_;
};

TEST_F(ModelError, ARobotThatFitsItsModelLoads) { EXPECT_EQ(message(), "no error"); }

TEST_F(ModelError, AnotherNumberOfJointsIsRefused) {
  robot_.joints.resize(2);
  EXPECT_THAT(message(), HasSubstr("robot.yaml: error: it lists 2 joints, "));
  EXPECT_THAT(message(), HasSubstr("biped.xml has 1"));
}

TEST_F(ModelError, AnotherOrderOfJointsIsRefused) {
  robot_.joints[0].name = "knee";
  EXPECT_THAT(message(), HasSubstr("joint 1 is 'knee' here and 'hip' in "));
  EXPECT_THAT(message(), HasSubstr("the order must be the same"));
}

TEST_F(ModelError, AModelWithoutAFloatingBaseIsRefused) {
  write(
      R"(<mujoco><worldbody><body><joint name="hip"/><geom size="0.1"/></body></worldbody></mujoco>)");
  EXPECT_THAT(message(), HasSubstr("must be the free joint of the floating base"));
}

TEST_F(ModelError, AnUnknownFloatingBaseIsRefused) {
  robot_.floating_base = "trunk";
  EXPECT_THAT(message(), HasSubstr("floating_base 'trunk' is not a body with a free joint"));
}

TEST_F(ModelError, AMissingSiteIsRefused) {
  robot_.contacts[0].site = "toe";
  EXPECT_THAT(message(), HasSubstr("contact 'foot' names the site 'toe', which "));
  robot_.contacts[0].site = "foot";
  robot_.points.push_back({"crown", "hat"});
  EXPECT_THAT(message(), HasSubstr("point 'crown' names the site 'hat'"));
}

TEST_F(ModelError, ABallJointIsRefused) {
  write(R"(<mujoco><worldbody><body name="torso"><freejoint/><geom size="0.1"/>
    <body><joint name="hip" type="ball"/><geom size="0.1"/><site name="foot"/></body>
    </body></worldbody></mujoco>)");
  EXPECT_THAT(message(), HasSubstr("joint 'hip' must be a hinge or a slide"));
}

TEST_F(ModelError, AJointWithoutANameIsRefused) {
  write(R"(<mujoco><worldbody><body name="torso"><freejoint/><geom size="0.1"/>
    <body><joint/><geom size="0.1"/><site name="foot"/></body></body></worldbody></mujoco>)");
  EXPECT_THAT(message(), HasSubstr("joint 1 is 'hip' here and '' in "));
}

TEST_F(ModelError, MalformedXmlIsMuJoCosOwnSentence) {
  write("<mujoco><worldbody><bodi/></worldbody></mujoco>");
  EXPECT_THAT(message(), HasSubstr("biped.xml: error: MuJoCo refuses it: "));
  EXPECT_THAT(message(), HasSubstr("bodi"));
}

TEST_F(ModelError, AMissingFileIsRefused) {
  robot_.model_path = (folder_ / "absent.xml").string();
  EXPECT_THAT(message(), HasSubstr("absent.xml: error: MuJoCo refuses it: "));
}

TEST_F(ModelError, AMassErrorOfAnUnknownLinkIsRefused) {
  deviation_.com_shift["trunk"] = {0.0, 0.0, 0.0};
  EXPECT_THAT(message(), HasSubstr("has no link 'trunk'"));
}

}  // namespace
}  // namespace footfall::tests
