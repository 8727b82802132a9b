// Reloads of a run: the new file's log goes on where the old one ends and both replay as one, wrong
// files are refused in the words of `check`, and a fault brings the former behavior back.
#include "lab/run/reload.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "behaviors/check/physics/check.h"
#include "lab/log/reader.h"
#include "lab/replay/replay.h"
#include "lab/run/run.h"
#include "tests/support/rig.h"

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;

constexpr double kAt = 0.8;   // s, of the first reload
constexpr double kEnd = 2.0;  // s

std::string source(const std::string& file) {
  return (fs::absolute(FOOTFALL_SOURCE_DIR) / file).lexically_normal().string();
}

const std::string kBalance = source("behaviors/library/balance_best.yaml");

class Reload : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::absolute(fs::path(testing::TempDir())) /
              ("footfall_reload_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    write("first.yaml", "base: " + kBalance + "\n");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }

  // Runs first.yaml and loads the files at their times.
  lab::RunResult run(const std::vector<lab::ScheduledReload>& files) {
    Rig rig(path("first.yaml"), 1);
    lab::ReloadSetup setup;
    setup.hardware = rig.backend.get();
    setup.load.search = {FOOTFALL_SOURCE_DIR};
    setup.source.settings.planner_latency = rig.world.planner_latency;
    setup.folder = folder_.string();
    setup.print = [this](const core::Diagnostics& found) { printed_ += found.to_string(); };
    setup.tell = [this](const std::string& line) { told_ += line + "\n"; };
    engine::LogWriter log(path("log.mcap"), rig.behavior->signals,
                          lab::make_log_header(*rig.behavior, setup.source));
    lab::Reloads reloads(*rig.loop, &log, setup);
    lab::RunSpec spec;
    spec.max_time = kEnd;
    spec.log = &log;
    spec.reloads = &reloads;
    spec.reload_at = files;
    spec.on_reload = [this](engine::ControlLoop& now) { names_.push_back(now.behavior().name); };
    const lab::RunResult result = lab::run(*rig.loop, spec);
    log.close();
    reloads.close();
    return result;
  }

  lab::Log read(const std::string& name) const {
    return lab::read_log(path(name), {.all_rows = true, .inputs = true});
  }

  // Whether the logs of the run replay bit for bit, one after the other.
  void expect_replay(int reloads) const {
    std::vector<lab::Log> logs = {read("log.mcap")};
    for (int k = 1; k <= reloads; ++k) {
      logs.push_back(
          lab::read_log(lab::reload_log(folder_.string(), k), {.all_rows = true, .inputs = true}));
    }
    lab::Replay replay(logs.front());
    for (std::size_t k = 0; k < logs.size(); ++k) {
      if (k > 0) replay.go_on(logs[k]);
      const lab::ReplayReport report = lab::verify_replay(logs[k], replay);
      EXPECT_EQ(report.differs_at, -1)
          << "log " << k << ": " << testing::PrintToString(report.lines);
      EXPECT_EQ(report.ticks, logs[k].inputs.first_tick + logs[k].inputs.ticks() -
                                  std::max<std::int64_t>(0, logs[k].inputs.first_tick));
    }
  }

  fs::path folder_;
  std::string printed_, told_;
  std::vector<std::string> names_;
};

TEST_F(Reload, TheLogGoesOnInItsOwnFolderAndAllOfItReplays) {
  write("second.yaml", "base: first.yaml\ngains: {single: {swing: {kp: 380}}}\n");
  const lab::RunResult result = run({{kAt, path("second.yaml")}});
  EXPECT_EQ(result.reloads, 1);
  EXPECT_EQ(result.end, lab::RunEnd::time);
  EXPECT_EQ(names_, std::vector<std::string>{"second"});
  EXPECT_NE(told_.find("second.yaml: reloaded at"), std::string::npos) << told_;
  const lab::Log first = read("log.mcap"), second = read("reload-1/log.mcap");
  EXPECT_EQ(second.inputs.first_tick, first.inputs.first_tick + first.inputs.ticks());
  EXPECT_EQ(second.run.at("behavior"), "second");
  EXPECT_EQ(second.inputs.first_tick + second.inputs.ticks(), 3000);
  expect_replay(1);
  EXPECT_THROW(lab::Replay alone(second), std::runtime_error);
}

TEST_F(Reload, OfABrokenFileIsRefusedInTheWordsOfCheck) {
  write("broken.yaml",
        "base: first.yaml\nmachine: {initial: setp}\ngains: {single: {swing: {kp: 4 N}}}\n");
  write("unsound.yaml",
        "base: first.yaml\nplanners: {foot: {kappa: {value: [-0.5, 0.25], range: [-1, 1]}}}\n");
  const lab::RunResult result = run({{kAt, path("broken.yaml")}, {1.2, path("unsound.yaml")}});
  EXPECT_EQ(result.reloads, 0);
  EXPECT_EQ(result.end, lab::RunEnd::time);
  std::string checked;
  for (const char* name : {"broken.yaml", "unsound.yaml"}) {
    core::Diagnostics found;
    behaviors::LoadOptions options;
    options.search = {FOOTFALL_SOURCE_DIR};
    const auto behavior = behaviors::load_behavior(path(name), options, found);
    if (behavior) behaviors::check_physics(*behavior, found);
    EXPECT_TRUE(found.has_errors()) << name;
    checked += found.to_string();
  }
  EXPECT_EQ(printed_, checked);
  EXPECT_FALSE(fs::exists(path("reload-1")));
}

TEST_F(Reload, AFaultBringsTheFormerBehaviorBack) {
  // Its guard has no value as soon as the swing begins: error.execution.
  write("faulty.yaml", R"(base: first.yaml
templates:
  stride:
    states:
      lift: {on_entry: [{log: "{sqrt(0 - com.pos.z/1 m)}"}]}
)");
  const lab::RunResult result = run({{kAt, path("faulty.yaml")}});
  EXPECT_EQ(result.reloads, 2);
  EXPECT_EQ(result.end, lab::RunEnd::time);
  EXPECT_EQ(names_, (std::vector<std::string>{"faulty", "first"}));
  EXPECT_NE(told_.find("taken back at"), std::string::npos) << told_;
  EXPECT_NE(told_.find("fault execution"), std::string::npos) << told_;
  expect_replay(2);
}

TEST_F(Reload, OfAnotherRobotIsRefused) {
  write("robot.yaml", "base: " + source("robots/hume/robot.yaml") + "\nlimits: {tilt: 0.7 rad}\n");
  write("other.yaml", "base: first.yaml\nrobot: robot.yaml\n");
  const lab::RunResult result = run({{kAt, path("other.yaml")}});
  EXPECT_EQ(result.reloads, 0);
  EXPECT_NE(told_.find("the robot has other limits"), std::string::npos) << told_;
}

}  // namespace
}  // namespace footfall::tests
