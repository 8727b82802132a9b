// A log replays bit for bit from itself alone; one bit of one gain is found; two logs are told
// apart where they part; a decision is explained by the values it was made from.
#include "lab/replay/replay.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "engine/log/writer.h"
#include "lab/log/diff.h"
#include "lab/replay/why.h"
#include "lab/run/log_setup.h"
#include "lab/run/run.h"
#include "lab/run/run_log.h"
#include "tests/support/rig.h"

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;

// A folder of the test's own with a behavior in it.
class Workshop : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("footfall_replay_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    // Not absolute: so the base, too, is the log's.
    const fs::path base = fs::absolute(FOOTFALL_SOURCE_DIR) / "behaviors/library/balance_best.yaml";
    write("balance.yaml", "base: " + base.lexically_relative(folder_).string() + "\n");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }

  // Runs 1.5 s with a push and a moving goal; returns the whole log.
  lab::Log run(const std::string& name, double push = 30.0) {
    Rig rig(path("balance.yaml"));
    lab::RunSpec spec;
    spec.max_time = 1.5;
    spec.goal = {{0.02, 0.0}};
    spec.goal_velocity = {{0.05, 0.01}};
    lab::ScheduledEvent event;
    event.at_time = 0.8;
    event.label = "push";
    event.fire = [&] { rig.backend->push(rig.backend->find_body("torso"), push, 1.0, 0.05); };
    spec.events.push_back(event);
    lab::LogSource source;
    source.settings.planner_latency = rig.world.planner_latency;
    engine::LogWriter log(path(name), rig.behavior->signals,
                          lab::make_log_header(*rig.behavior, source));
    spec.log = &log;
    lab::run(*rig.loop, spec);
    log.close();
    return lab::read_log(path(name), {.all_rows = true, .inputs = true});
  }

  fs::path folder_;
};

// Attributes of MJCF and of URDF, in either kind of quotes; a word that only contains `file` is
// none.
TEST_F(Workshop, TheFilesThatAModelNamesAreKept) {
  for (const char* name : {"a.stl", "b.stl", "c.png", "d.stl", "part.xml", "none.stl"})
    write(name, "x");
  fs::create_directories(path("meshes"));
  write("meshes/e.stl", "x");
  write("part.xml", "<mujoco><mesh file='b.stl'/></mujoco>");
  write("model.xml",
        "<mujoco><compiler meshdir = 'meshes'/><include file=\"part.xml\"/>\n<mesh\nfile = "
        "\"a.stl\"/><texture name='x' file='c.png'/><mesh filename='d.stl'/><mesh file='e.stl'/>"
        "<user profile='none.stl'/></mujoco>");
  behaviors::Behavior behavior;
  behavior.robot.model_path = path("model.xml");
  std::vector<std::string> names;
  for (const engine::LogFile& file : lab::source_files(behavior, "")) {
    names.push_back(fs::path(file.path).filename().string());
  }
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"a.stl", "b.stl", "c.png", "d.stl", "e.stl",
                                             "model.xml", "part.xml"}));
}

TEST_F(Workshop, ALogReplaysBitForBitFromItselfAlone) {
  const lab::Log log = run("a.mcap");
  EXPECT_GT(log.edits.size(), 1000U);  // the goal moves in every tick
  EXPECT_GT(log.plans.size(), 10U);
  fs::remove(path("balance.yaml"));  // the log has its own
  lab::Replay replay(log);
  const lab::ReplayReport report = lab::verify_replay(log, replay);
  EXPECT_EQ(report.differs_at, -1) << report.differs_at;
  EXPECT_EQ(report.ticks, 2250);
  EXPECT_TRUE(report.parameters.empty());
}

// From 100 % to a third in one tick: the torque follows at the robot's bound, and the log says so.
TEST_F(Workshop, ABaseThatWasFoundByItsNameIsInTheLog) {
  write("balance.yaml", "base: balance_best\n");
  const lab::Log log = run("a.mcap");
  EXPECT_TRUE(std::ranges::any_of(log.files, [](const lab::LoggedFile& file) {
    return file.path.ends_with("/behaviors/library/balance_best.yaml");
  }));
  lab::Replay replay(log);  // it searches nowhere but in the log
  EXPECT_EQ(lab::verify_replay(log, replay).differs_at, -1);
}

TEST_F(Workshop, AHardEditReplaysWithTheLimitsThatItHad) {
  Rig rig(path("balance.yaml"));
  lab::RunSpec spec;
  spec.max_time = 1.0;
  lab::ScheduledEvent event;
  event.at_time = 0.6;
  event.label = "edit";
  event.fire = [&] {
    engine::EditBatch batch;
    batch.source = engine::EditSource::scenario;
    batch.who = "ann@bench";
    batch.note = "redo";
    const int height = rig.behavior->find_parameter("gains.dual.height.kp");
    ASSERT_GE(height, 0);
    const auto& info = rig.behavior->parameters[static_cast<std::size_t>(height)];
    const double value = rig.behavior->values[static_cast<std::size_t>(info.slot)];
    for (int k = 0; k < info.size; ++k) batch.values.push_back({info.slot + k, value / 3.0});
    EXPECT_EQ(rig.loop->edits().submit(batch).reasons, std::vector<std::string>{});
  };
  spec.events.push_back(event);
  engine::LogWriter writer(path("hard.mcap"), rig.behavior->signals,
                           lab::make_log_header(*rig.behavior, {}));
  spec.log = &writer;
  lab::run(*rig.loop, spec);
  writer.close();
  const lab::Log log = lab::read_log(path("hard.mcap"), {.all_rows = true, .inputs = true});
  ASSERT_FALSE(log.edits.empty());
  EXPECT_EQ(log.edits.front().tick, 900);
  EXPECT_TRUE(log.edits.front().limit_steps);
  const auto told = std::ranges::find(log.events, "edit", &lab::LoggedEvent::kind);
  ASSERT_NE(told, log.events.end());
  EXPECT_EQ(told->name, "scenario ann@bench (redo)");
  EXPECT_EQ(told->detail, "gains.dual.height.kp = 90");  // a third of 270
  lab::Replay replay(log);
  EXPECT_EQ(lab::verify_replay(log, replay).differs_at, -1);
}

TEST_F(Workshop, ACutLogReplaysAsFarAsItGoes) {
  run("a.mcap");
  fs::resize_file(path("a.mcap"), fs::file_size(path("a.mcap")) * 2 / 3);
  const lab::Log log = lab::read_log(path("a.mcap"), {.all_rows = true, .inputs = true});
  EXPECT_FALSE(log.complete);
  lab::Replay replay(log);
  const lab::ReplayReport report = lab::verify_replay(log, replay);
  EXPECT_EQ(report.differs_at, -1);
  EXPECT_GT(report.ticks, 500);
  EXPECT_LT(report.ticks, 2250);
}

TEST_F(Workshop, OneBitOfOneGainIsFound) {
  const lab::Log log = run("a.mcap");
  const auto gain =
      std::ranges::find(log.parameters, "gains.single.place.kp", &lab::LoggedParameter::name);
  ASSERT_NE(gain, log.parameters.end());
  const auto slot = static_cast<std::size_t>(gain->slot);
  const double old = log.parameter_values[slot + 1];
  const double other = std::nextafter(old, 1e9);
  write("other.yaml",
        fmt::format("base: balance.yaml\ngains:\n  single:\n    place: {{kp: [{}, {}]}}\n",
                    log.parameter_values[slot], other));
  lab::Replay replay(log, path("other.yaml"));
  const lab::ReplayReport report = lab::verify_replay(log, replay);
  ASSERT_EQ(report.parameters.size(), 1U);
  EXPECT_EQ(report.parameters[0],
            fmt::format("gains.single.place.kp.y: {} in the log, {} now", old, other));
  EXPECT_GT(report.differs_at, 0);
  // The stack with this gain is in force from there on, and its foot is not quite at rest.
  EXPECT_NE(report.state.find("unload"), std::string::npos) << report.state;
  EXPECT_FALSE(report.lines.empty());
}

TEST_F(Workshop, TwoEqualRunsHaveEqualLogs) {
  const lab::LogComparison found = lab::compare_logs(run("a.mcap"), run("b.mcap"));
  EXPECT_TRUE(found.same());
  EXPECT_EQ(found.ticks, 2250);
}

TEST_F(Workshop, TwoRunsPartWhereOneIsPushedHarder) {
  const lab::LogComparison found = lab::compare_logs(run("a.mcap"), run("b.mcap", 40.0));
  EXPECT_TRUE(found.setup.empty());
  ASSERT_FALSE(found.differences.empty());
  // The push acts from 0.8 s on; the tick after measures what it did.
  EXPECT_EQ(found.differences[0].kind, "input");
  EXPECT_EQ(found.differences[0].tick, 1201);
}

TEST_F(Workshop, ATransitionIsExplainedByItsTimer) {
  const lab::Log log = run("a.mcap");
  const auto lift = std::ranges::find_if(log.events, [](const lab::LoggedEvent& e) {
    return e.kind == "transition" && e.name.ends_with("unload");
  });
  ASSERT_NE(lift, log.events.end());
  lab::Replay at(log), before(log);
  const std::string taken = lab::explain_tick(at, lift->tick);
  EXPECT_NE(taken.find("taken:\n  " + lift->name + " -> "), std::string::npos) << taken;
  EXPECT_NE(taken.find("after due since 0 ticks"), std::string::npos) << taken;
  const std::string waiting = lab::explain_tick(before, lift->tick - 3);
  EXPECT_NE(waiting.find("taken: none"), std::string::npos) << waiting;
  EXPECT_NE(waiting.find("after 3 ticks (0.002 s) left   <- no"), std::string::npos) << waiting;
}

TEST_F(Workshop, AGuardIsExplainedByItsTerms) {
  write("balance.yaml",
        "behavior: 1\nrobot: hume\nparameters: {patience: {value: 2 s}}\nmachine:\n  states:\n"
        "    stand:\n      contacts: [right_foot, left_foot]\n"
        "      tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 20}}}\n"
        "      transitions: [{when: \"contact.left_foot and t > $patience\", to: stand}]\n");
  Rig rig(path("balance.yaml"));
  lab::RunSpec spec;
  spec.max_time = 0.1;
  engine::LogWriter writer(path("c.mcap"), rig.behavior->signals,
                           lab::make_log_header(*rig.behavior, lab::LogSource{}));
  spec.log = &writer;
  lab::run(*rig.loop, spec);
  writer.close();
  const lab::Log log = lab::read_log(path("c.mcap"), {.all_rows = true, .inputs = true});
  lab::Replay replay(log);
  const std::string text = lab::explain_tick(replay, 75);
  EXPECT_NE(text.find("when  contact.left_foot true\n"), std::string::npos) << text;
  EXPECT_NE(text.find("when  t 0.05 s > $patience 2 s   <- no\n"), std::string::npos) << text;
}

// tests/data has a small log of each format before this one.
TEST(LogFormats, LogsOfFormersAreReadAndNotRepeated) {
  const std::string path = FOOTFALL_SOURCE_DIR "/tests/data/log_format_1.mcap";
  const lab::Log log = lab::read_log(path, {.all_rows = true, .inputs = true});
  EXPECT_EQ(log.get("behavior"), "nod");
  EXPECT_EQ(log.get("format", "1"), "1");
  EXPECT_EQ(log.inputs.ticks(), 91);  // 60 ms at 1500 Hz, and what start() read
  ASSERT_NE(log.values("com.pos.z"), nullptr);
  EXPECT_NEAR(log.values("com.pos.z")->front(), 0.911, 1e-3);
  try {
    lab::Replay replay(log);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("only format 2 can be repeated"), std::string::npos);
  }
}

TEST_F(Workshop, WhatIsNoLogOfARunIsOneSentence) {
  core::SignalTable table;
  table.add("time", core::kTime, "");
  engine::LogHeader header;
  header.run = {{"format", std::to_string(lab::kLogFormat)}};
  engine::LogWriter(path("d.mcap"), table, header).close();
  const lab::Log log = lab::read_log(path("d.mcap"), {.all_rows = true, .inputs = true});
  try {
    lab::Replay replay(log);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the log does not say how its run was set up, so it has no replay");
  }
}

}  // namespace
}  // namespace footfall::tests
