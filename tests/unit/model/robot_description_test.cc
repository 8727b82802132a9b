// Robot files: a whole small one, and each mistake an error at its place.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "model/robot/description.h"

namespace footfall::model {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr std::string_view kModel = R"(<mujoco><worldbody><body name="torso"><freejoint/>
  <geom size="0.1"/></body></worldbody></mujoco>)";

constexpr std::string_view kRobot = R"(robot: 1
name: biped
model: biped.xml
floating_base: torso
rate: 1500 Hz
standing_height: 84 cm
posture: {"*hip": -25 deg, left_knee: 50 deg, "*knee": 55 deg}
joints:
  right_hip: {position: [-2, 2], torque: 100 Nm, sea: {spring: 360 Nm/rad, rotor: 0.0873 kg m^2}}
  right_knee: {position: [-20 deg, 200 deg], torque: 80 Nm}
  left_hip: {position: [-100 deg, 100 deg], torque: 100 Nm}
  left_knee: {position: [-20 deg, 200 deg], torque: 80 Nm}
groups: {right_leg: ["right_*"], left_leg: [left_knee, left_hip]}
contacts:
  right_foot: {site: right_foot_site, type: point, group: right_leg, radius: 25 mm}
  left_foot: {site: left_foot_site, group: left_leg}
points: {head: {site: head_site}}
symmetry: {swap: [[right_foot, left_foot], [right_leg, left_leg]]}
sensors: {imu: {site: imu_site}, mocap: {sites: ["led_*", crown]}, switches: ["*_foot"]}
limits: {tilt: 0.7 rad, height: 65 %, torque_step: 5 Nm, edit_ramp: 80 ms, swing: 1.5 s, overruns: 4}
faults: {fall: safe_stop, imu.stale: safe_state, torque.limit: continue}
)";

class RobotDescriptionTest : public testing::Test {
 protected:
  RobotDescriptionTest()
      : folder_(std::filesystem::path(testing::TempDir()) /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "biped.xml") << kModel;
  }
  ~RobotDescriptionTest() override { std::filesystem::remove_all(folder_); }

  RobotDescription load(std::string_view text) {
    std::ofstream(path()) << text;
    diagnostics_ = {};
    return load_robot(path(), diagnostics_);
  }
  std::string path() const { return (folder_ / "robot.yaml").string(); }

  // The problems of kRobot with `from` replaced by `to`, without the path before the line.
  std::string problems(std::string_view from, std::string_view to) {
    std::string text(kRobot);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    load(text.replace(at, from.size(), to));
    std::string out = diagnostics_.to_string();
    for (std::size_t i = out.find(path()); i != std::string::npos; i = out.find(path())) {
      out.erase(i, path().size() + 1);
    }
    return out;
  }

  std::filesystem::path folder_;
  core::Diagnostics diagnostics_;
};

TEST_F(RobotDescriptionTest, AWholeFileIsRead) {
  const RobotDescription robot = load(kRobot);
  ASSERT_EQ(diagnostics_.to_string(), "");
  EXPECT_EQ(robot.name, "biped");
  EXPECT_EQ(robot.model_path, (folder_ / "biped.xml").lexically_normal().string());
  EXPECT_EQ(robot.floating_base, "torso");
  EXPECT_EQ(robot.rate_mhz, 1'500'000);
  EXPECT_DOUBLE_EQ(robot.rate_hz(), 1500.0);
  EXPECT_DOUBLE_EQ(robot.period_s(), 1.0 / 1500.0);
  EXPECT_DOUBLE_EQ(robot.standing_height, 0.84);

  ASSERT_EQ(robot.joint_count(), 4);
  const JointDescription& hip = robot.joints[0];
  EXPECT_EQ(hip.name, "right_hip");
  EXPECT_DOUBLE_EQ(hip.position_min, -2.0);  // a bare number is SI
  EXPECT_DOUBLE_EQ(robot.joints[2].position_min, -100 * kDegree);
  EXPECT_DOUBLE_EQ(hip.torque_limit, 100);
  EXPECT_DOUBLE_EQ(hip.spring, 360);
  EXPECT_DOUBLE_EQ(hip.rotor, 0.0873);
  EXPECT_DOUBLE_EQ(hip.posture, -25 * kDegree);
  EXPECT_DOUBLE_EQ(robot.joints[1].posture, 55 * kDegree);
  EXPECT_DOUBLE_EQ(robot.joints[3].posture, 50 * kDegree);  // the exact name goes first
  EXPECT_EQ(robot.joints[1].spring, 0.0);

  EXPECT_EQ(robot.groups[0].joints, (std::vector<int>{0, 1}));
  EXPECT_EQ(robot.groups[1].joints, (std::vector<int>{3, 2}));
  ASSERT_EQ(robot.contacts.size(), 2u);
  EXPECT_EQ(robot.contacts[0].site, "right_foot_site");
  EXPECT_EQ(robot.contacts[0].group, "right_leg");
  EXPECT_DOUBLE_EQ(robot.contacts[0].radius, 0.025);
  EXPECT_EQ(robot.contacts[1].type, ContactType::point);
  EXPECT_EQ(robot.points[0].site, "head_site");
  EXPECT_EQ(robot.sensors.imu_site, "imu_site");
  EXPECT_EQ(robot.sensors.mocap_sites, (std::vector<std::string>{"led_*", "crown"}));
  EXPECT_EQ(robot.sensors.switches, (std::vector<int>{0, 1}));
  ASSERT_EQ(robot.symmetry.size(), 2u);
  EXPECT_EQ(robot.symmetry[1][1], "left_leg");
  EXPECT_DOUBLE_EQ(robot.tilt_limit, 0.7);
  EXPECT_DOUBLE_EQ(robot.height_limit, 0.65);
  EXPECT_DOUBLE_EQ(robot.torque_step_limit, 5);
  EXPECT_DOUBLE_EQ(robot.edit_ramp, 0.08);
  EXPECT_DOUBLE_EQ(robot.swing_limit, 1.5);
  EXPECT_EQ(robot.overruns, 4);
  EXPECT_EQ(robot.find_joint("left_hip"), 2);
  EXPECT_EQ(robot.find_contact("left_foot"), 1);
  EXPECT_EQ(robot.find_group("nobody"), -1);
}

TEST_F(RobotDescriptionTest, AUrdfIsRefusedInOneLineWhateverItIsCalled) {
  std::ofstream(folder_ / "other.xml") << "<?xml version=\"1.0\"?><!-- <mujoco/> -->\n"
                                          "<robot name=\"x\"><link name=\"base\"/></robot>";
  EXPECT_EQ(problems("biped.xml", "other.xml"),
            "3:8: error: 'other.xml' is a URDF file, which this version does not read; expected "
            "MJCF with a free joint, motors and sites\n");
}

TEST_F(RobotDescriptionTest, ReactionsHaveSafeDefaults) {
  const RobotDescription robot = load(kRobot);
  const auto reaction = [&robot](core::Fault fault) {
    return robot.reactions[static_cast<std::size_t>(fault)];
  };
  EXPECT_EQ(reaction(core::Fault::fall), core::Reaction::safe_stop);
  EXPECT_EQ(reaction(core::Fault::imu_stale), core::Reaction::safe_state);
  EXPECT_EQ(reaction(core::Fault::torque_limit), core::Reaction::keep_going);
  EXPECT_EQ(reaction(core::Fault::non_finite), core::Reaction::safe_stop);
  EXPECT_EQ(reaction(core::Fault::simulator_warning), core::Reaction::safe_state);
  EXPECT_EQ(reaction(core::Fault::planner_late), core::Reaction::keep_going);
  EXPECT_EQ(reaction(core::Fault::swing_too_long), core::Reaction::safe_stop);
  EXPECT_EQ(reaction(core::Fault::no_estimate), core::Reaction::safe_stop);
}

TEST_F(RobotDescriptionTest, TheLimitOfConditionIsARatio) {
  EXPECT_DOUBLE_EQ(load(kRobot).condition_limit, 100.0);
  std::string text(kRobot);
  const std::string key = "overruns: 4";
  text.replace(text.find(key), key.size(), key + ", condition: 40");
  EXPECT_DOUBLE_EQ(load(text).condition_limit, 40.0);
  EXPECT_NE(problems("overruns: 4", "condition: 0.5").find("a ratio of at least 1"),
            std::string::npos);
}

TEST_F(RobotDescriptionTest, AFaultAfterWhichNothingCanGoOnRefusesToContinue) {
  for (const char* fault : {"fall", "simulator", "non_finite", "no_estimate"}) {
    const std::string text = problems("fall: safe_stop", std::string(fault) + ": continue");
    EXPECT_NE(text.find("'" + std::string(fault) + "' cannot continue"), std::string::npos) << text;
  }
}

TEST_F(RobotDescriptionTest, AFaultThatTheRobotCanNeverHaveIsRefused) {
  EXPECT_NE(problems("imu: {site: imu_site}, ", "").find("never has 'imu.stale'"),
            std::string::npos);
}

TEST_F(RobotDescriptionTest, AnotherKindIsOneLine) {
  EXPECT_EQ(problems("robot: 1\n", ""),
            "1:1: error: not a robot file: expected 'robot: 1' as the first key, got 'name'\n");
  EXPECT_EQ(problems("robot: 1\n", "robot: 3\n"),
            "1:8: error: this program reads 'robot: 1', not version '3'\n");
}

TEST_F(RobotDescriptionTest, AMissingFileIsOneLine) {
  load_robot((folder_ / "none.yaml").string(), diagnostics_);
  EXPECT_EQ(diagnostics_.to_string(),
            (folder_ / "none.yaml").string() + ": error: cannot read: No such file or directory\n");
}

TEST_F(RobotDescriptionTest, UnknownKeysAndMissingModel) {
  EXPECT_EQ(problems("standing_height", "standing_heigth"),
            "6:1: error: unknown key 'standing_heigth' (did you mean 'standing_height'?)\n");
  EXPECT_EQ(problems("biped.xml", "none.xml"),
            "3:8: error: no model file '" + (folder_ / "none.xml").string() + "'\n");
  EXPECT_EQ(problems("floating_base: torso\n", ""),
            "1:1: error: the key 'floating_base' is missing\n");
}

TEST_F(RobotDescriptionTest, DimensionsAreChecked) {
  EXPECT_EQ(problems("1500 Hz", "1500 s"), "5:7: error: expected a rate in Hz, got '1500 s'\n");
  EXPECT_EQ(problems("torque: 80 Nm", "torque: 80 N"),
            "10:54: error: expected a torque, got '80 N'\n");
  EXPECT_EQ(problems("torque: 80 Nm", "torque: -80 Nm"),
            "10:54: error: expected a torque above zero, got '-80 Nm'\n");
  EXPECT_EQ(problems("tilt: 0.7 rad", "tilt: 4 rad"),
            "20:16: error: expected an angle, 0 to 3.14159, got '4 rad'\n");
  EXPECT_EQ(problems("[-20 deg, 200 deg]", "[200 deg, -20 deg]"),
            "10:26: error: expected [minimum, maximum], got '200 deg' before '-20 deg'\n");
}

TEST_F(RobotDescriptionTest, PerJointMapsTakeGlobs) {
  EXPECT_EQ(problems(R"("*hip": -25 deg)", R"("*ankle": 0)"),
            "7:11: error: '*ankle' matches no joint: there are right_hip, right_knee, left_hip, "
            "left_knee\n");
  EXPECT_EQ(problems(R"("*hip": -25 deg)", R"("right*": 0)"),
            "7:43: error: '*knee' and 'right*' (line 7) both match joint 'right_knee'\n");
  EXPECT_EQ(problems("left_knee: 50 deg", "left_kne: 50 deg"),
            "7:28: error: no joint 'left_kne' (did you mean 'left_knee'?)\n");
  EXPECT_EQ(problems("left_knee: 50 deg", "left_knee: 300 deg"),
            "7:39: error: '300 deg' is outside the limits of 'left_knee' (-20 to 200 deg)\n");
}

TEST_F(RobotDescriptionTest, ReferencesBetweenItsPartsAreChecked) {
  EXPECT_EQ(problems("group: right_leg", "group: right_lag"),
            "15:59: error: no group 'right_lag' (did you mean 'right_leg'?)\n");
  EXPECT_EQ(problems("[right_leg, left_leg]]", "[right_arm, left_leg]]"),
            "18:45: error: no contact, group, point or joint 'right_arm' (did you mean "
            "'right_leg'?)\n");
  EXPECT_EQ(problems("[right_leg, left_leg]]", "[right_foot, left_leg]]"),
            "18:45: error: 'right_foot' changes places twice\n");
  EXPECT_EQ(problems("points: {head:", "points: {left_foot:"),
            "17:10: error: 'left_foot' is a contact already, and a contact is a point\n");
  EXPECT_EQ(problems("type: point", "type: blob"),
            "15:45: error: expected a type of contact: point, surface or fixed, got 'blob'\n");
  EXPECT_EQ(problems(R"(switches: ["*_foot"])", "switches: [right_hand]"),
            "19:79: error: no contact 'right_hand': there are right_foot, left_foot\n");
}

TEST_F(RobotDescriptionTest, FaultsAndReactionsAreNamesOfALIst) {
  EXPECT_EQ(problems("imu.stale: safe_state", "imu.stal: safe_state"),
            "21:27: error: no fault 'imu.stal' (did you mean 'imu.stale'?)\n");
  EXPECT_EQ(problems("imu.stale: safe_state", "imu.stale: ignore"),
            "21:38: error: expected a reaction: continue, safe_state or safe_stop, got 'ignore'\n");
}

TEST_F(RobotDescriptionTest, AllProblemsAreFoundInOnePass) {
  load(
      "robot: 1\nmodel: [1]\nfloating_base:\nrate: fast\njoints: {a: 3, no: {}}\ngroups: 5\n"
      "contacts: []\npoints: x\nsensors: 1\nsymmetry: {swap: [a]}\nlimits: 2\nfaults: []\n");
  // One or more of every line from the second to the last.
  for (int line = 2; line <= 12; ++line) {
    EXPECT_NE(diagnostics_.to_string().find(path() + ":" + std::to_string(line) + ":"),
              std::string::npos)
        << line << "\n"
        << diagnostics_.to_string();
  }
}

TEST_F(RobotDescriptionTest, AVariantTakesTheModelFromItsBasesFolder) {
  load(kRobot);
  std::filesystem::create_directories(folder_ / "heavy");
  const std::string variant = (folder_ / "heavy" / "robot.yaml").string();
  std::ofstream(variant) << "robot: 1\nbase: ../robot.yaml\nname: heavy\nrate: 1 kHz\n";
  const RobotDescription robot = load_robot(variant, diagnostics_);
  ASSERT_EQ(diagnostics_.to_string(), "");
  EXPECT_EQ(robot.name, "heavy");
  EXPECT_EQ(robot.rate_mhz, 1'000'000);
  EXPECT_EQ(robot.joint_count(), 4);
  EXPECT_EQ(robot.model_path, (folder_ / "biped.xml").lexically_normal().string());
}

TEST_F(RobotDescriptionTest, ARobotIsFoundByFileOrName) {
  load(kRobot);
  EXPECT_EQ(find_robot_file(path(), {}), path());
  const std::filesystem::path home = folder_ / "robots" / "biped";
  std::filesystem::create_directories(home);
  std::ofstream(home / "robot.yaml") << kRobot;
  EXPECT_EQ(find_robot_file("biped", {"/nowhere", folder_.string()}),
            (home / "robot.yaml").string());
  EXPECT_EQ(find_robot_file("nobody", {folder_.string()}), "");
  EXPECT_EQ(find_robot_file("", {folder_.string()}), "");
}

}  // namespace
}  // namespace footfall::model
