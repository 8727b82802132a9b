// Reloads of a run: the new file's log goes on where the old one ends and both replay as one, wrong
// files are refused in the words of `check`, and a fault brings the former behavior back.
#include "lab/run/reload.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <utility>

#include "behaviors/check/physics/check.h"
#include "core/realtime/allocation_count.h"
#include "engine/realtime/executive.h"
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

// A file that is to take over from a time on.
struct Request {
  double time = 0.0;  // s
  std::string path;
};

// What stands beside a run with `--reload`, in the run's own thread, so that runs repeat.
class Beside final : public lab::RunObserver {
 public:
  Beside(const engine::ControlLoop& first, lab::Reloads& reloads, std::vector<Request> requests)
      : period_(first.period()), reloads_(reloads), requests_(std::move(requests)) {}
  void before_tick(const lab::StepClock& /*steps*/, lab::RunLog& /*log*/) override {
    const double time = static_cast<double>(tick_++) * period_;
    for (Request& next : requests_) {
      if (next.path.empty() || time < next.time) continue;
      reloads_.request(std::exchange(next.path, ""));
    }
    reloads_.tend();
  }
  void after_tick() override {}

 private:
  double period_;
  std::int64_t tick_ = 0;
  lab::Reloads& reloads_;
  std::vector<Request> requests_;
};

// Counts the heap calls of swaps, those back too, with all that they set off in the executive and
// its observers.
class Counted final : public engine::LoopExchange {
 public:
  explicit Counted(lab::Reloads& reloads) : reloads_(reloads) {}
  engine::ControlLoop* swap() override {
    return count([&] { return reloads_.swap(); });
  }
  engine::ControlLoop* take_back() override {
    return count([&] { return reloads_.take_back(); });
  }
  std::unique_ptr<engine::LiveBinding> take_binding() override { return reloads_.take_binding(); }
  std::function<void()> before, after;  // a swap
  int swaps = 0;

 private:
  template <class Step>
  engine::ControlLoop* count(const Step& step) {
    if (before) before();
    core::arm_allocation_count(true);
    engine::ControlLoop* const now = step();
    core::arm_allocation_count(false);
    if (after) after();
    swaps += now != nullptr ? 1 : 0;
    return now;
  }
  lab::Reloads& reloads_;
};

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

  lab::ReloadSetup setup(const Rig& rig) {
    lab::ReloadSetup setup;
    setup.hardware = rig.backend.get();
    setup.load.search = {FOOTFALL_SOURCE_DIR};
    setup.source.settings.planner_latency = rig.world.planner_latency;
    setup.folder = folder_.string();
    setup.print = [this](const core::Diagnostics& found) { printed_ += found.to_string(); };
    setup.tell = [this](const std::string& line) { told_ += line + "\n"; };
    return setup;
  }

  // Runs first.yaml and loads the files at their times.
  lab::RunResult run(const std::vector<Request>& files, double end = kEnd) {
    Rig rig(path("first.yaml"));
    const lab::ReloadSetup how = setup(rig);
    engine::LogWriter log(path("log.mcap"), rig.behavior->signals,
                          lab::make_log_header(*rig.behavior, how.source));
    lab::Reloads reloads(*rig.loop, how);
    Beside beside(*rig.loop, reloads, files);
    lab::RunSpec spec;
    spec.max_time = end;
    spec.log = &log;
    spec.reloads = &reloads;
    spec.observer = &beside;
    const lab::RunResult result = lab::run(*rig.loop, spec);
    log.close();
    reloads.close();
    return result;
  }

  lab::Log read(const std::string& name) const {
    return lab::read_log(path(name), {.all_rows = true, .inputs = true});
  }

  // Of the behaviors that ran, by their logs.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (int k = 1; fs::exists(lab::reload_log(folder_.string(), k)); ++k) {
      names.push_back(lab::read_log(lab::reload_log(folder_.string(), k)).run.at("behavior"));
    }
    return names;
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
};

TEST_F(Reload, TheLogGoesOnInItsOwnFolderAndAllOfItReplays) {
  write("second.yaml", "base: first.yaml\ngains: {single: {swing: {kp: 380}}}\n");
  const lab::RunResult result = run({{kAt, path("second.yaml")}});
  EXPECT_EQ(result.reloads, 1);
  EXPECT_EQ(result.end, lab::RunEnd::time);
  EXPECT_EQ(names(), std::vector<std::string>{"second"});
  EXPECT_FALSE(fs::exists(path("reload-2")));  // the way back that nobody needed
  EXPECT_NE(told_.find("second.yaml: reloaded at"), std::string::npos) << told_;
  const lab::Log first = read("log.mcap"), second = read("reload-1/log.mcap");
  EXPECT_EQ(second.inputs.first_tick, first.inputs.first_tick + first.inputs.ticks());
  EXPECT_EQ(second.run.at("behavior"), "second");
  EXPECT_EQ(second.inputs.first_tick + second.inputs.ticks(), 3000);
  expect_replay(1);
  EXPECT_THROW(lab::Replay alone(second), std::runtime_error);
}

// An estimator takes over the state of one of another type, and the robot walks on.
TEST_F(Reload, ToOtherEstimatorsAndBackItStands) {
  write("cameras.yaml", "base: first.yaml\nestimator: {type: motion_capture}\n");
  write("legs.yaml", "base: first.yaml\nestimator: {type: contact_kalman}\n");
  // Each is past the probation of the one before.
  const lab::RunResult result = run({{0.8, path("cameras.yaml")},
                                     {3.4, path("legs.yaml")},
                                     {6.0, path("cameras.yaml")},
                                     {8.6, path("first.yaml")}},
                                    11.0);
  EXPECT_EQ(result.end, lab::RunEnd::time) << told_ << printed_;
  EXPECT_EQ(result.reloads, 4) << told_ << printed_;
  EXPECT_EQ(names(), (std::vector<std::string>{"cameras", "legs", "cameras", "first"}));
  expect_replay(4);
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
  EXPECT_EQ(names(), (std::vector<std::string>{"faulty", "first"}));
  EXPECT_NE(told_.find("taken back at"), std::string::npos) << told_;
  EXPECT_NE(told_.find("fault execution"), std::string::npos) << told_;
  expect_replay(2);
}

TEST_F(Reload, AfterTheProbationTheNumberOfTheUnusedWayBackIsTheNextOnes) {
  write("robot.yaml",
        "base: " + source("robots/hume/robot.yaml") + "\nlimits: {reload_watch: 300 ms}\n");
  write("first.yaml", "base: " + kBalance + "\nrobot: robot.yaml\n");
  write("second.yaml", "base: first.yaml\ngains: {single: {swing: {kp: 380}}}\n");
  write("third.yaml", "base: first.yaml\ngains: {single: {swing: {kp: 390}}}\n");
  // The third comes while the second is on probation, and waits for its end.
  const lab::RunResult result = run({{kAt, path("second.yaml")}, {1.1, path("third.yaml")}}, 3.0);
  EXPECT_EQ(result.reloads, 2);
  EXPECT_EQ(names(), (std::vector<std::string>{"second", "third"}));
  EXPECT_FALSE(fs::exists(path("reload-3")));
  expect_replay(2);
}

TEST_F(Reload, OneThatNeverTakesOverLeavesNoFile) {
  // In the last tick.
  write("second.yaml", "base: first.yaml\n");
  const lab::RunResult result = run({{kEnd - 0.001, path("second.yaml")}});
  EXPECT_EQ(result.reloads, 0);
  EXPECT_FALSE(fs::exists(path("reload-1")));
}

// All is there before: the folder of the logs is not even at its place when the loops change.
TEST_F(Reload, TheSwapAndTheTakingBackAllocateNothingAndOpenNoFile) {
  write("faulty.yaml", R"(base: first.yaml
templates:
  stride:
    states:
      lift: {on_entry: [{log: "{sqrt(0 - com.pos.z/1 m)}"}]}
)");
  Rig rig(path("first.yaml"));
  const lab::ReloadSetup how = setup(rig);
  lab::Reloads reloads(*rig.loop, how);
  Counted counted(reloads);
  const fs::path elsewhere = folder_.string() + "_elsewhere";
  counted.before = [&] { fs::rename(folder_, elsewhere); };
  counted.after = [&] {
    EXPECT_FALSE(fs::exists(folder_));
    fs::rename(elsewhere, folder_);
  };
  // As in a run: the log of a loop that took over begins, and says so.
  struct Log final : engine::TickObserver {
    explicit Log(lab::Reloads& all) : reloads(all) {}
    void before_tick(engine::ControlLoop& loop) override {
      if (loop.ticks() == 1200) reloads.request(path);
      reloads.tend();
    }
    bool ends(const engine::ControlLoop& loop) override { return loop.ticks() >= 3000; }
    void after_compute(engine::ControlLoop& /*loop*/) override {
      if (log != nullptr) log->after_tick({});
    }
    void withdrawn(engine::ControlLoop& /*loop*/) override { log->after_tick({}); }
    void exchanged(engine::ControlLoop& now) override {
      core::arm_allocation_count(true);
      lab::ReloadNews news;
      while (reloads.take_news(news)) {
        if (log != nullptr) log->event("reload", news.what.view(), news.detail.view());
      }
      log = &reloads.log();
      log->begin();
      log->before_tick();
      log->event("reload", "begins", now.behavior().name);
      core::arm_allocation_count(false);
    }
    lab::Reloads& reloads;
    std::string path;
    lab::RunLog* log = nullptr;
  } log(reloads);
  log.path = path("faulty.yaml");
  const std::int64_t before = core::allocation_count();
  engine::Executive executive(*rig.loop, {.exchange = &counted});
  executive.attach(log);
  EXPECT_EQ(executive.run(), engine::ExecutiveEnd::observer);
  EXPECT_EQ(counted.swaps, 2);
  EXPECT_EQ(core::allocation_count() - before, 0);
  reloads.close();
  EXPECT_EQ(names(), (std::vector<std::string>{"faulty", "first"}));
  const lab::Log back = read("reload-2/log.mcap");
  EXPECT_EQ(back.inputs.first_tick + back.inputs.ticks(), 3000);
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
