// `estimator:`: its type, its parameters as slots, and what the robot must have.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "behaviors/language/estimators.h"
#include "tests/unit/behaviors/behavior_test_support.h"
#include "tests/unit/behaviors/save/save_test_support.h"

namespace footfall::tests {
namespace {

using behaviors::Behavior;
using behaviors::ContactSource;
using behaviors::EstimatorType;
using behaviors::LoadOptions;

std::string with_estimator(const std::string& section) {
  return "behavior: 1\nrobot: hume\nestimator: " + section + "\nmachine: {}\n";
}

// Hume with other sensors or contacts.
LoadOptions with_robot(const std::string& name, const std::string& keys) {
  const std::string path = testing::TempDir() + "/footfall_estimator_" + name + ".yaml";
  std::ofstream(path) << "robot: 1\nbase: "
                      << std::filesystem::absolute(FOOTFALL_SOURCE_DIR).string()
                      << "/robots/hume/robot.yaml\n"
                      << keys;
  LoadOptions options = options_for_tests();
  options.robot = path;
  return options;
}

double value_of(const Behavior& b, const std::string& name) {
  const int p = b.find_parameter(name);
  return p < 0 ? -1.0
               : b.values[static_cast<std::size_t>(b.parameters[static_cast<std::size_t>(p)].slot)];
}

TEST(EstimatorSection, IsTheTrueStateWithoutParametersWhereNothingIsSaid) {
  const auto b = load("behavior: 1\nrobot: hume\nmachine: {}\n");
  EXPECT_EQ(b->estimator.type, EstimatorType::true_state);
  EXPECT_EQ(b->estimator.slots, 0);
}

TEST(EstimatorSection, HasASlotForEachParameterOfItsTypeInTheOrderOfTheTable) {
  for (const EstimatorType type : {EstimatorType::motion_capture, EstimatorType::contact_kalman}) {
    const behaviors::EstimatorInfo& info = behaviors::estimator_info(type);
    const auto b = load(with_estimator("{type: " + std::string(info.name) + "}"));
    EXPECT_EQ(b->estimator.type, type);
    EXPECT_EQ(b->estimator.contact, ContactSource::switches);
    ASSERT_EQ(b->estimator.slots, std::ssize(info.parameters));
    for (std::size_t k = 0; k < info.parameters.size(); ++k) {
      const behaviors::EstimatorParameter& row = info.parameters[k];
      const int p = b->find_parameter("estimator." + std::string(row.name));
      ASSERT_GE(p, 0) << row.name;
      const behaviors::ParameterInfo& made = b->parameters[static_cast<std::size_t>(p)];
      EXPECT_EQ(made.slot, b->estimator.first_slot + static_cast<int>(k));
      EXPECT_EQ(b->values[static_cast<std::size_t>(made.slot)], row.value);
      EXPECT_EQ(made.live, !row.name.starts_with("start_")) << row.name;
      EXPECT_TRUE(made.size == 1 && made.of_estimator());
      EXPECT_EQ(made.min, row.least);
      EXPECT_EQ(made.max, row.most);
      EXPECT_EQ(made.doc, row.doc);
    }
  }
}

TEST(EstimatorSection, TakesValuesFromTheFileAndFromSet) {
  const std::string text =
      with_estimator("{type: motion_capture, contact: both, joint_velocity_filter: 7 ms}");
  const auto b = load(text);
  EXPECT_EQ(b->estimator.contact, ContactSource::both);
  EXPECT_DOUBLE_EQ(value_of(*b, "estimator.joint_velocity_filter"), 7e-3);
  LoadOptions options = options_for_tests();
  options.set = {{"estimator.joint_velocity_filter", "9 ms"}};
  EXPECT_DOUBLE_EQ(value_of(*load(text, options), "estimator.joint_velocity_filter"), 9e-3);
}

TEST(EstimatorSection, IsMadeBySetWhereTheFileHasNone) {
  LoadOptions options = options_for_tests();
  options.set = {{"estimator.type", "contact_kalman"}, {"estimator.contact", "torque"}};
  const auto b = load("behavior: 1\nrobot: hume\nmachine: {}\n", options);
  EXPECT_EQ(b->estimator.type, EstimatorType::contact_kalman);
  EXPECT_EQ(b->estimator.contact, ContactSource::torque);
}

TEST(EstimatorSection, NeedsASwitchAtEachContactUnlessTorquesTellThem) {
  const LoadOptions one_switch = with_robot("one_switch", "sensors: {switches: [left_foot]}\n");
  EXPECT_NE(problems(with_estimator("{type: contact_kalman}"), one_switch)
                .find("the estimator contact_kalman needs a switch at contact 'right_foot', or "
                      "`contact: torque`"),
            std::string::npos);
  EXPECT_NO_THROW(load(with_estimator("{type: contact_kalman, contact: torque}"), one_switch));
}

TEST(EstimatorSection, NeedsTheLegOfAContactThatTorquesTell) {
  const LoadOptions no_leg = with_robot("no_leg", "contacts: {left_foot: {group: off}}\n");
  const std::string said =
      problems(with_estimator("{type: contact_kalman, contact: both}"), no_leg);
  EXPECT_NE(said.find("b.yaml:3:44: error: the estimator contact_kalman needs the leg of contact "
                      "'left_foot' for `contact: both`"),
            std::string::npos)
      << said;
  EXPECT_NO_THROW(load(with_estimator("{type: contact_kalman}"), no_leg));
}

TEST(EstimatorSection, NeedsTheImu) {
  const LoadOptions no_imu =
      with_robot("no_imu", "sensors: {imu: off}\nfaults: {imu.stale: off}\n");
  const std::string said = problems(with_estimator("{type: contact_kalman}"), no_imu);
  EXPECT_NE(said.find("b.yaml:3:19: error: the estimator contact_kalman needs an IMU"),
            std::string::npos)
      << said;
}

TEST(EstimatorSection, NeedsThreeMarkersWhereMotionCaptureGivesTheAttitude) {
  const LoadOptions two = with_robot("two", "sensors: {mocap: {sites: [led_1, led_2]}}\n");
  const std::string said = problems(with_estimator("{type: motion_capture}"), two);
  EXPECT_NE(said.find("b.yaml:3:19: error: the estimator motion_capture needs 3 motion-capture "
                      "markers or more: `sensors: {mocap: ...}` of robot 'hume' means 2"),
            std::string::npos)
      << said;
}

class EstimatorFiles : public SaveTest {};

TEST_F(EstimatorFiles, MergeKeyByKeyOverABase) {
  put("base.yaml", with_estimator("{type: motion_capture, joint_velocity_filter: 7 ms}"));
  put("over.yaml", "behavior: 1\nbase: base.yaml\nestimator: {contact: torque}\n");
  core::Diagnostics diagnostics;
  const auto b = behaviors::load_behavior(file("over.yaml"), options_for_tests(), diagnostics);
  ASSERT_NE(b, nullptr) << diagnostics.to_string();
  EXPECT_EQ(b->estimator.type, EstimatorType::motion_capture);
  EXPECT_EQ(b->estimator.contact, ContactSource::torque);
  EXPECT_DOUBLE_EQ(value_of(*b, "estimator.joint_velocity_filter"), 7e-3);
}

TEST_F(EstimatorFiles, RefuseABasesParameterThatTheirOwnTypeDoesNotHave) {
  put("base.yaml", with_estimator("{type: motion_capture, joint_velocity_filter: 7 ms}"));
  put("over.yaml", "behavior: 1\nbase: base.yaml\nestimator: {type: true_state}\n");
  core::Diagnostics diagnostics;
  EXPECT_EQ(behaviors::load_behavior(file("over.yaml"), options_for_tests(), diagnostics), nullptr);
  EXPECT_NE(diagnostics.to_string().find("`joint_velocity_filter: off` removes what a base gives"),
            std::string::npos)
      << diagnostics.to_string();
  put("over.yaml",
      "behavior: 1\nbase: base.yaml\nestimator: {type: true_state, joint_velocity_filter: off}\n");
  core::Diagnostics none;
  EXPECT_NE(behaviors::load_behavior(file("over.yaml"), options_for_tests(), none), nullptr)
      << none.to_string();
}

TEST_F(EstimatorFiles, GetAnEditedParameterBackAlsoWhereTheyDoNotNameIt) {
  EXPECT_EQ(saved(with_estimator("{type: motion_capture, joint_velocity_filter: 7 ms}"),
                  {{"estimator.joint_velocity_filter", {8e-3}}}),
            with_estimator("{type: motion_capture, joint_velocity_filter: 8 ms}"));
  EXPECT_EQ(saved(with_estimator("{type: motion_capture}"),
                  {{"estimator.joint_velocity_filter", {8e-3}}}),
            with_estimator("{type: motion_capture, joint_velocity_filter: 0.008 s}"));
}

}  // namespace
}  // namespace footfall::tests
