// Torque loops: stability of the sampled loop against the drive itself stepped through time,
// passivity against the closed forms by hand, and where findings stand.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "behaviors/check/actuators/drives.h"
#include "behaviors/check/actuators/sampled_torque_loop.h"
#include "hal/actuators/drive.h"
#include "tests/support/hume.h"
#include "tests/unit/behaviors/check/physics_test_support.h"

namespace footfall::tests {
namespace {

using behaviors::torque_loop_growth;
using hal::TorqueLoopGains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr double kStep = 1.0 / 12000.0;                                          // s
constexpr hal::SeriesElasticParameters kHip{.spring = 360, .rotor = 0.0872756};  // Hume's right hip

// What `check` finds, but for joints whose gains these tables leave at 0.
template <typename... More>
std::string physics(const std::string& text, const More&... more) {
  std::string kept;
  std::istringstream lines(tests::physics(text, more...));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("no torque at all") == std::string::npos) kept += line + "\n";
  }
  return kept;
}

// Whether an error grows: 1, decays: -1, or neither within the time given: 0.
int stepped(const TorqueLoopGains& gains, const hal::RateFilters& filters, int steps) {
  hal::DriveSettings settings;
  settings.joints = {{kHip, kHip.spring, gains}};
  settings.step = kStep;
  settings.filters = filters;
  hal::SeriesElasticDrive drive(settings);
  const std::array<double, 1> start{1.0}, zero{0.0};
  std::array<double, 1> out{};
  drive.start(zero, start);
  drive.command(zero);
  const double energy = drive.actuator(0).energy();
  for (int k = 0; k < steps; ++k) {
    drive.advance(zero, out);
    if (drive.actuator(0).energy() > 1e8 * energy) return 1;
  }
  return drive.actuator(0).energy() < 1e-8 * energy ? -1 : 0;
}

TEST(SampledTorqueLoop, GrowsExactlyWhereTheDriveDoes) {
  std::mt19937_64 random(7);
  const auto draw = [&](double least, double most) {
    return std::exp(std::uniform_real_distribution(std::log(least), std::log(most))(random));
  };
  int grown = 0, decayed = 0;
  for (int k = 0; k < 300; ++k) {
    TorqueLoopGains gains;
    gains.type = k % 2 == 0 ? TorqueLoopGains::Type::cascade : TorqueLoopGains::Type::direct;
    gains.p = draw(0.5, 100.0);
    gains.i = k % 3 == 0 ? 0.0 : draw(0.1, 1e4);
    gains.velocity_p = draw(1.0, 3000.0);
    gains.velocity_i = k % 5 == 0 ? 0.0 : draw(1.0, 3000.0);
    gains.damping = draw(1.0, 3000.0);
    gains.observer = k % 7 == 0 ? draw(1.0, 60.0) : 0.0;
    gains.damps = k % 8 < 4 ? TorqueLoopGains::Damping::motor : TorqueLoopGains::Damping::spring;
    const hal::RateFilters filters{k % 4 < 2 ? draw(100.0, 1000.0) : 0.0,
                                   k % 3 == 0 ? HUGE_VAL : draw(100.0, 1000.0)};
    const double growth = torque_loop_growth(gains, kHip, kStep, filters);
    if (std::abs(growth - 1.0) < 1e-3) continue;  // too slow to wait for
    const int seen = stepped(gains, filters, 30000);
    EXPECT_EQ(seen, growth > 1.0 ? 1 : -1) << k << ": " << growth;
    ++(growth > 1.0 ? grown : decayed);
  }
  EXPECT_GT(grown, 50);
  EXPECT_GT(decayed, 20);
}

// Without p and i the rotor only swings: a held damping torque is stable up to about 2 J / T.
TEST(SampledTorqueLoop, BearsDampingUpToTwiceTheRotorByThePeriod) {
  TorqueLoopGains gains;
  gains.type = TorqueLoopGains::Type::direct;
  gains.damping = 1.99 * kHip.rotor / kStep;
  EXPECT_LT(torque_loop_growth(gains, kHip, kStep), 1.0);
  gains.damping = 2.01 * kHip.rotor / kStep;
  EXPECT_GT(torque_loop_growth(gains, kHip, kStep), 1.0);
}

std::string with_table(const std::string& tables, const std::string& use = "right_leg: t") {
  return "behavior: 1\nrobot: hume\ngains: {g: {rest: {kd: 2}}}\ntorque_loop:\n" + tables +
         "stacks:\n  s:\n    contacts: [right_foot, left_foot]\n    gains: g\n"
         "    tasks: {rest: {type: joint_damping, priority: 1}}\n    torque_loop: {" +
         use + "}\nmachine: {stack: s}\n";
}

behaviors::LoadOptions on_robot(const std::string& name, const std::string& lines) {
  const std::string path = testing::TempDir() + "/footfall_" + name + ".yaml";
  std::ofstream(path) << "robot: 1\nbase: "
                      << std::filesystem::absolute(FOOTFALL_SOURCE_DIR).string()
                      << "/robots/hume/robot.yaml\n" + lines;
  behaviors::LoadOptions options = options_for_tests();
  options.robot = path;
  return options;
}

// The number that follows a text in a finding.
double number_after(const std::string& text, const std::string& before) {
  const std::size_t found = text.find(before);
  return found == std::string::npos ? std::nan("") : std::stod(text.substr(found + before.size()));
}

TEST(TorqueLoopCheck, FindsNothingInTheRobotsOwnGainsAndInTheTablesOfKim2016) {
  EXPECT_EQ(physics(with_table("  t: {type: direct, p: 20}\n")), "");
  EXPECT_EQ(physics(with_table("  t: {p: {\"*abduction\": 2.84, \"*hip\": 43, \"*knee\": 22}, i: "
                               "{\"*abduction\": 0.15}}\n",
                               "right_leg: t, left_leg: t")),
            "");
}

TEST(TorqueLoopCheck, AnInnerIntegralBeyondTheClosedFormIsNotPassive) {
  // (1 + P_v P_t) P_v / (J P_t) = 6 * 5 / 0.0872756 = 343.7 N m/rad; stable up to some 400.
  const std::string text =
      with_table("  t: {p: {right_hip: 1}, velocity_p: 5, velocity_i: {right_hip: 370 Nm/rad}}\n");
  const std::string found = physics(text);
  EXPECT_THAT(found,
              StartsWith(place_of(text, "370") + "warning: torque_loop 't' is not passive in "
                                                 "'right_hip': it can give energy"));
  EXPECT_THAT(found, HasSubstr("velocity_i 370 Nm: at most 343.7 Nm with this p, velocity_p and "
                               "rotor"));
  EXPECT_EQ(physics(with_table("  t: {p: {right_hip: 1}, velocity_p: 5, velocity_i: {right_hip: "
                               "343}}\n")),
            "");
}

// With D on θ' − q' the admittance is D/(J k) − I/(J w²): an integral is active below w² = I k / D.
TEST(TorqueLoopCheck, AnIntegralWhoseDampingIsTheSpringsIsNotPassiveAtLowFrequencies) {
  const std::string text =
      with_table("  t: {type: direct, p: 20, i: {right_hip: 5 1/s}, d: {right_hip: 36}}\n");
  const std::string found = physics(text);
  EXPECT_THAT(found,
              StartsWith(place_of(text, "5 1/s") + "warning: torque_loop 't' is not passive"));
  const double bound = std::pow(2.0 * std::numbers::pi * 0.1, 2) * 36.0 / 360.0;
  EXPECT_NEAR(number_after(found, "at most "), bound, 1e-3 * bound);
  EXPECT_EQ(physics(with_table("  t: {type: direct, p: 20, i: {right_hip: 5}, d: {right_hip: 36}, "
                               "damps: motor}\n")),
            "");
}

TEST(TorqueLoopCheck, AnUnstableLoopIsAnErrorWithTheMostThatIsStable) {
  const auto with_p = [](double p) {
    return with_table(fmt::format("  t: {{p: {{right_hip: {}}}, velocity_p: 5 Nm s/rad}}\n", p));
  };
  const std::string found = physics(with_p(200));
  EXPECT_THAT(found,
              StartsWith(place_of(with_p(200), "200") + "error: torque_loop 't' is unstable in "
                                                        "'right_hip': at 12000 Hz"));
  const double bound = number_after(found, "at most ");
  EXPECT_GT(bound, 58.57);
  EXPECT_EQ(physics(with_p(0.999 * bound)), "");
  EXPECT_THAT(physics(with_p(1.001 * bound)), HasSubstr("error: torque_loop 't' is unstable"));
}

TEST(TorqueLoopCheck, NamesTheGainWithoutWhichTheRestIsStable) {
  const auto of = [](const std::string& gains) {
    return physics(with_table("  t: {type: direct, damps: motor, " + gains + "}\n"));
  };
  EXPECT_NEAR(number_after(of("p: 1, d: {\"*\": 40, right_hip: 3000}"), "d 3000 Nm s: at most "),
              2.0 * kHip.rotor / kStep, 1.0);
  EXPECT_THAT(of("p: 20, d: {\"*\": 40, right_hip: 0}"), HasSubstr("d 0 Nm s: at least "));
  EXPECT_THAT(of("p: {\"*\": 20, right_hip: 5e4}, d: 40"), HasSubstr("p 50000: at most "));
  EXPECT_THAT(of("p: 20, i: {right_hip: 2e4}, d: 40"), HasSubstr("i 20000 1/s: at most "));
}

TEST(TorqueLoopCheck, JointsThatShareAValueShareAFinding) {
  const std::string text = with_table("  t: {p: 200, velocity_p: 5}\n");
  const std::string found = physics(text);
  EXPECT_THAT(found, StartsWith(place_of(text, "200")));
  EXPECT_THAT(found, HasSubstr("(and in 2 more joints)"));
  EXPECT_EQ(found.find('\n'), found.size() - 1) << found;
}

TEST(TorqueLoopCheck, EachEndOfALiveRangeIsTried) {
  const std::string text =
      with_table("  ranges: {p: [0, 200]}\n  t: {p: {right_hip: 20}, velocity_p: 5}\n");
  EXPECT_THAT(
      physics(text),
      HasSubstr("warning: torque_loop 't' is unstable in 'right_hip' at the end of the range "
                "of 'torque_loop.t.p'"));
  EXPECT_EQ(
      physics(with_table("  ranges: {p: [0, 40]}\n  t: {p: {right_hip: 20}, velocity_p: 5}\n")),
      "");
}

TEST(TorqueLoopCheck, ATableThatNoStateUsesIsNotJudged) {
  EXPECT_EQ(physics(with_table("  t: {type: direct, p: 20}\n  u: {p: 200, velocity_p: 5}\n")), "");
}

TEST(TorqueLoopCheck, AJointWithoutActuatorIsAnErrorOnlyOnARobotWithOthers) {
  const std::string text = with_table("  t: {p: 20}\n");
  EXPECT_EQ(physics(text, on_robot("one_ideal", "joints: {right_hip: {sea: off}}\n")),
            place_of(text, "t: {p") +
                "error: joint 'right_hip' has no series-elastic actuator (sea) in robot 'hume': "
                "torque_loop 't' cannot apply to it\n");
  const std::string all =
      "joints: {right_abduction: {sea: off}, right_hip: {sea: off}, right_knee: {sea: off},\n"
      "         left_abduction: {sea: off}, left_hip: {sea: off}, left_knee: {sea: off}}\n";
  EXPECT_EQ(physics(text, on_robot("all_ideal", all)), "");
}

TEST(TorqueLoopCheck, WithoutInnerGainNothingIsKnown) {
  const behaviors::LoadOptions bare = on_robot("no_drives_to_judge", "drives: off\n");
  EXPECT_EQ(physics(with_table("  t: {p: 58.57, i: 900}\n"), bare), "");
  EXPECT_EQ(physics(with_table("  t: {type: direct, p: 20}\n"), bare), "");
  EXPECT_THAT(physics(with_table("  t: {p: 200, velocity_p: 5}\n"), bare), HasSubstr("unstable"));
}

TEST(TorqueLoopCheck, AnInnerIntegralNeedsAnInnerGain) {
  const std::string found = physics(with_table(
      "  ranges: {velocity_p: [0, 8]}\n  t: {p: 20, velocity_p: {right_hip: 5}, velocity_i: 1}\n"));
  EXPECT_THAT(found, HasSubstr("at the end of the range of 'torque_loop.t.velocity_p'"));
  EXPECT_THAT(found, HasSubstr("velocity_p 0 Nm s: at least "));
}

TEST(TorqueLoopCheck, ARangeOfAnInnerGainIsTriedThoughItsValueIsZero) {
  const std::string text =
      with_table("  ranges: {velocity_p: [0, 5000]}\n  t: {p: 20, velocity_p: 0}\n");
  EXPECT_THAT(physics(text),
              StartsWith(place_of(text, "0}\nstacks") + "warning: torque_loop 't' is "
                                                        "unstable in "));
  EXPECT_THAT(physics(text), Not(HasSubstr("error: ")));
}

TEST(TorqueLoopCheck, ALiveEditThatWouldBeUnstableIsRefused) {
  const auto b = load(with_table("  ranges: {p: [0, 200]}\n  t: {p: 20, velocity_p: 5}\n"));
  behaviors::EditedValues edited(*b);
  std::vector<double> values = b->values;
  EXPECT_TRUE(edited.errors(values).empty());
  values[static_cast<std::size_t>(b->torque_loops[0].slots[0] + b->robot.find_joint("right_hip"))] =
      190.0;
  const auto errors = edited.errors(values);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].id, "unstable-torque-loop");
}

// Joints that a table's leg has and its p does not name: p of the robot's loops is of another type.
TEST(TorqueLoopCheck, AJointThatGetsNoTorqueAtAllIsTold) {
  EXPECT_EQ(
      tests::physics(with_table("  t: {p: {right_hip: 20}, velocity_p: 5}\n")),
      "b.yaml:5:3: warning: torque_loop 't' gives 'right_abduction' no torque at all: expected "
      "p (and velocity_p of a cascade) above 0; p and i of the robot's own loops are of their "
      "type only\n");
}

TEST(TorqueLoopCheck, TheRobotsOwnLoopsAreJudgedWithoutABehavior) {
  model::RobotDescription robot = load_hume();
  core::Diagnostics good;
  behaviors::check_drives(robot, good);
  EXPECT_EQ(good.to_string(), "");
  robot.drives.torque_loop[4].damping *= 100.0;  // more than the rate of 12 kHz can damp
  core::Diagnostics bad;
  behaviors::check_drives(robot, bad);
  EXPECT_NE(bad.to_string().find("the torque loop of 'left_hip' is unstable"), std::string::npos);
  robot.drives.torque_loop.clear();
  core::Diagnostics unknown;
  behaviors::check_drives(robot, unknown);
  EXPECT_EQ(unknown.to_string(), "");
}

}  // namespace
}  // namespace footfall::tests
