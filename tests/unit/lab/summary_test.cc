// The summary: which keys it has, what is null, and what it says of the backend.
#include "lab/run/summary.h"

#include <gtest/gtest.h>

#include "tests/support/fake_robot.h"
#include "tests/support/rig.h"

namespace footfall::tests {
namespace {

TEST(Summary, HasEveryKeyThatScriptsRelyOn) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 3.0;
  const lab::RunResult result = lab::run(*rig.loop, spec);
  const auto json =
      lab::summary_json({"balance", "hume", "flat", "mujoco", 7, "out/log.mcap", ""}, result);
  for (const char* key : {"behavior",
                          "robot",
                          "world",
                          "backend",
                          "seed",
                          "end",
                          "steps",
                          "time_s",
                          "fell",
                          "error",
                          "foot_placement_m",
                          "max_torque_step_Nm",
                          "peak_torque_Nm",
                          "goal_error_m",
                          "path_length_m",
                          "internal_force",
                          "faults",
                          "tick_us",
                          "allocations",
                          "real_time_factor",
                          "log"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  for (const char* angle : {"roll", "pitch", "yaw", "height"}) {
    EXPECT_TRUE(json["error"][angle]["rms"].is_number()) << angle;
    EXPECT_TRUE(json["error"][angle]["max"].is_number()) << angle;
  }
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["end"], "time");
  EXPECT_EQ(json["fell"], false);
  EXPECT_TRUE(json["foot_placement_m"]["mean"].is_number());
  EXPECT_TRUE(json["tick_us"]["p999"].is_number());
  EXPECT_TRUE(json["allocations"].is_null());  // this program does not count them
  EXPECT_TRUE(json["faults"].is_object());
}

TEST(Summary, FootholdsAreToldWhereTheGroundHasErrors) {
  lab::RunIdentity id;
  EXPECT_TRUE(lab::summary_json(id, {})["footholds"].is_null());
  EXPECT_EQ(lab::summary_text(id, {}).find("footholds"), std::string::npos);
  id.footholds = 3;
  EXPECT_EQ(lab::summary_json(id, {})["footholds"], 3);
  EXPECT_NE(lab::summary_text(id, {}).find("  footholds    3 with a height drawn anew\n"),
            std::string::npos);
}

TEST(Summary, AnAidedRunNeverLooksUnaided) {
  lab::RunIdentity id;
  EXPECT_EQ(lab::summary_json(id, {})["constraints"], nlohmann::ordered_json::array());
  EXPECT_EQ(lab::summary_text(id, {}).find("AIDED"), std::string::npos);
  id.constraints = {"harness", "hold of torso"};
  EXPECT_EQ(lab::summary_json(id, {})["constraints"][1], "hold of torso");
  EXPECT_NE(lab::summary_text(id, {}).find("  AIDED        by harness, hold of torso\n"),
            std::string::npos);
}

// Of the two tables one is given to six joints in one state and to three in the other.
TEST(Summary, TellsOfATorqueLoopThatTheBackendDoesNotUse) {
  StubRig rig(R"(
behavior: 1
robot: hume
torque_loop: {stance: {p: 1}, swing: {type: direct, d: 10 Nm s/rad}}
machine:
  states:
    both: {contacts: [], torque_loop: {right_leg: stance, left_leg: stance}, after: 1 s, to: one}
    one: {contacts: [], torque_loop: {right_leg: stance, left_leg: swing}}
)");
  const auto unused = lab::unused_torque_loops(*rig.behavior, *rig.hardware);
  ASSERT_EQ(unused.size(), 2U);
  lab::RunIdentity id = {"b", "hume", "flat", "stub", 1, "", "", unused};
  const std::string line =
      "  torque loop  'stance' of 6 joints, 'swing' of 3 joints not used: the actuators are ideal "
      "in this world\n";
  EXPECT_NE(lab::summary_text(id, {}).find(line), std::string::npos) << lab::summary_text(id, {});
  const auto json = lab::summary_json(id, {});
  EXPECT_EQ(json["unused_torque_loops"].dump(),
            R"([{"name":"stance","joints":6},{"name":"swing","joints":3}])");
  id.unused_torque_loops.clear();
  EXPECT_EQ(lab::summary_text(id, {}).find("torque loop"), std::string::npos);
  // One that has such a loop is not told of.
  struct Elastic final : hal::Hardware {
    std::string name() const override { return "elastic"; }
    void start() override {}
    bool read(hal::Sensors& /*sensors*/) noexcept override { return true; }
    void write(const hal::Commands& /*commands*/) noexcept override {}
    void safe_stop() noexcept override {}
    bool uses_torque_loop() const override { return true; }
  } elastic;
  EXPECT_TRUE(lab::unused_torque_loops(*rig.behavior, elastic).empty());
}

// A shipped example lasts a second or two: figures from 2 s on would be empty.
TEST(Summary, ARunShorterThanFourSecondsCountsFromTheBeginning) {
  for (const auto& [time, from] : {std::pair(1.0, 0.0), std::pair(3.9, 0.0), std::pair(4.1, 2.0)}) {
    Rig rig("balance");
    lab::RunSpec spec;
    spec.max_time = time;
    const auto json = lab::summary_json({"balance", "hume", "flat", "mujoco", 1, "", ""},
                                        lab::run(*rig.loop, spec));
    EXPECT_EQ(json["counted_from_s"], from) << time;
    EXPECT_FALSE(json["error"]["height"].is_null()) << time;
    EXPECT_GT(json["peak_torque_Nm"], 0.0) << time;
  }
}

// 75 ticks of one stale IMU are one appearance and 75 ticks.
TEST(Summary, AFaultThatStaysHasAppearedOnceAndIsThereInManyTicks) {
  StubRig rig(R"(
behavior: 1
robot: hume
machine:
  tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}
)",
              1.0, nullptr, [](behaviors::Behavior& b) { b.robot.mocap_age = 0.0; });
  rig.hardware->spoil = [](hal::Sensors& s, std::int64_t tick) {
    s.mocap_fresh = tick < 5 || tick >= 80;
  };
  lab::RunSpec spec;
  spec.max_time = 100.0 * rig.behavior->period();
  const lab::RunResult result = lab::run(*rig.loop, spec);
  const auto json = lab::summary_json({"b", "hume", "flat", "stub", 1, "", ""}, result);
  EXPECT_EQ(json["faults"]["mocap.stale"], 1);
  EXPECT_EQ(json["fault_ticks"]["mocap.stale"], 75);
  EXPECT_EQ(json["format"], 2);
}

TEST(Summary, WhatDoesNotApplyIsNull) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 0.1;  // before any step
  const lab::RunResult result = lab::run(*rig.loop, spec);
  const auto json = lab::summary_json({"balance", "hume", "flat", "mujoco", 1, "", ""}, result);
  for (const char* key : {"foot_placement_m", "goal_error_m", "log"}) {
    EXPECT_TRUE(json[key].is_null()) << key;
  }
  EXPECT_EQ(json["steps"], 0);
}

// The behavior counts its marks, the run what the feet do: where they differ wholly, it is said.
TEST(Summary, MarkedStepsThatNoFootMadeAreSaid) {
  lab::RunResult result;
  result.marked_steps = 7;
  const lab::RunIdentity id = {"balance", "hume", "flat", "mujoco", 1, "", ""};
  EXPECT_NE(lab::summary_text(id, result).find("NO STEPS     the behavior marked 7, but no foot"),
            std::string::npos);
  EXPECT_EQ(lab::summary_json(id, result)["marked_steps"], 7);
  result.figures.steps = 6;
  EXPECT_EQ(lab::summary_text(id, result).find("NO STEPS"), std::string::npos);
  result.figures.steps = 0;
  result.marked_steps = 0;
  EXPECT_EQ(lab::summary_text(id, result).find("NO STEPS"), std::string::npos);
}

TEST(Summary, WhatAWallClockMeasuredIsInASecondFile) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 0.1;
  const lab::RunResult result = lab::run(*rig.loop, spec);
  const lab::RunIdentity id = {"balance", "hume", "flat", "mujoco", 1, "", ""};
  const auto physics = lab::summary_json(id, result, true);
  EXPECT_FALSE(physics.contains("tick_us"));
  EXPECT_FALSE(physics.contains("real_time_factor"));
  EXPECT_TRUE(lab::timing_json(result).contains("tick_us"));
}

}  // namespace
}  // namespace footfall::tests
