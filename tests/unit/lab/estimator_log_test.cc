// Logs of runs on an estimate: live edits of the estimator replay, and logs of before there were
// estimators are read.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "lab/replay/estimation.h"
#include "lab/replay/replay.h"
#include "lab/report/report.h"
#include "sim/world/description.h"
#include "tests/support/logged_run.h"

namespace footfall::tests {
namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A run of a behavior on the tuned balance, in its own folder.
class EstimatorLog : public testing::Test {
 protected:
  void SetUp() override { folder_ = temporary("estimator_log"); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) {
    std::filesystem::create_directories(folder_);
    return folder_ + "/" + name;
  }

  // `edit` > 0: estimator.lambda becomes that many metres at 1 s.
  lab::Log run(const std::string& behavior, double edit, const std::string& file) {
    core::Diagnostics problems;
    Rig rig(behavior, sim::load_world(FOOTFALL_SOURCE_DIR "/sim/worlds/lab.yaml", problems));
    lab::RunSpec spec;
    spec.max_time = 1.5;
    lab::ScheduledEvent event;
    event.at_time = 1.0;
    event.label = "edit";
    event.fire = [&] {
      const int lambda = rig.behavior->find_parameter("estimator.lambda");
      ASSERT_GE(lambda, 0);
      engine::EditBatch batch;
      batch.source = engine::EditSource::scenario;
      const auto& info = rig.behavior->parameters[static_cast<std::size_t>(lambda)];
      batch.values.push_back({info.slot, edit});
      EXPECT_EQ(rig.loop->edits().submit(batch).reasons, std::vector<std::string>{});
    };
    if (edit > 0.0) spec.events.push_back(event);
    engine::LogWriter log(path(file), rig.behavior->signals,
                          lab::make_log_header(*rig.behavior, {}));
    spec.log = &log;
    lab::run(*rig.loop, spec);
    log.close();
    return lab::read_log(path(file), {.all_rows = true, .inputs = true});
  }

  std::string folder_;
};

// The time of the first row in which a signal differs; -1: none does.
double parts_at(const lab::Log& a, const lab::Log& b, const std::string& signal) {
  const auto* x = a.values(signal);
  const auto* y = b.values(signal);
  for (std::size_t row = 0; x != nullptr && y != nullptr && row < a.rows(); ++row) {
    if ((*x)[row] != (*y)[row]) return a.time[row];
  }
  return -1.0;
}

TEST_F(EstimatorLog, ALiveEditOfLambdaActsFromItsTickOnAndReplays) {
  const lab::Log same = run("balance_lab", 0.0, "same.mcap");
  const lab::Log edited = run("balance_lab", 0.2, "edited.mcap");
  ASSERT_EQ(edited.edits.size(), same.edits.size() + 1);
  EXPECT_GE(parts_at(same, edited, "base.rpy.roll"), 1.0);
  lab::Replay replay(edited);
  const lab::ReplayReport report = lab::verify_replay(edited, replay);
  EXPECT_EQ(report.differs_at, -1) << testing::PrintToString(report.lines);
}

// What is new in the metadata of a log's columns is spelt so that no reader knows it: as if it had
// never been written. Metadata lie as plain text in the file.
std::string without_new_keys(std::string bytes) {
  const std::size_t columns = bytes.find("columns");
  for (const std::string key : {"markers", "estimation", "aids"}) {
    const std::size_t at = bytes.find(key, columns);
    EXPECT_NE(at, std::string::npos) << key;
    if (at != std::string::npos) bytes[at] = 'X';
  }
  return bytes;
}

TEST(OldLog, WithoutMarkersAndEstimationIsReadReplayedAndReported) {
  const std::string path = temporary("old.mcap");
  {
    Rig rig("balance_best");
    lab::RunSpec spec;
    spec.max_time = 0.5;
    engine::LogWriter log(path, rig.behavior->signals, lab::make_log_header(*rig.behavior, {}));
    spec.log = &log;
    lab::run(*rig.loop, spec);
    log.close();
  }
  const std::string old = without_new_keys(bytes_of(path));
  std::ofstream(path, std::ios::binary) << old;
  const lab::Log log = lab::read_log(path, {.all_rows = true, .inputs = true});
  std::filesystem::remove(path);
  EXPECT_TRUE(log.complete);
  EXPECT_FALSE(log.inputs.names.estimation);
  EXPECT_TRUE(log.inputs.names.markers.empty());
  lab::Replay replay(log);
  EXPECT_EQ(lab::verify_replay(log, replay).differs_at, -1);
  EXPECT_GT(lab::replay_estimator(log, {"true_state", {}, 0.0}).ticks, 0);
  EXPECT_NE(lab::report_html(log, {}).find("</html>"), std::string::npos);
}

}  // namespace
}  // namespace footfall::tests
