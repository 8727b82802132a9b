// A changed behavior on its way into a run: loaded and checked beside it, with a control loop, logs
// and queues of its own, so that taking over costs the run an exchange of pointers and a copy of
// values: no heap, no file.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "behaviors/check/physics/check.h"
#include "behaviors/compiled/take_over_map.h"
#include "behaviors/loader.h"
#include "core/diagnostics/diagnostics.h"
#include "engine/log/writer.h"
#include "engine/realtime/live_port.h"
#include "engine/tick/control_loop.h"
#include "hal/hardware.h"
#include "lab/run/log_setup.h"
#include "lab/run/run_log.h"

namespace footfall::lab {

// What a run gives for its reloads.
struct ReloadSetup {
  hal::Hardware* hardware = nullptr;
  behaviors::LoadOptions load;       // as the first behavior was loaded
  behaviors::PhysicsWorld world;     // that it is checked for
  LogSource source;                  // likewise; its settings are those of every control loop
  std::string folder;                // of the run's log; empty: none is written
  engine::LivePort* live = nullptr;  // of the run; nullptr: none
  RunLog::Said said;                 // see RunSpec
  // Every problem of a file, as it is found; from the thread that loads.
  std::function<void(const core::Diagnostics&)> print;
  // One line on what became of a reload, from any thread.
  std::function<void(const std::string&)> tell;
};

// Files by path, each with a digest of its content.
using FileDigests = std::map<std::string, std::uint64_t>;

// What a loop writes to from the tick in which it takes over. All is open before that; the log's
// file has its name only from then on (until then NAME.part), and is removed if it never comes.
class RunOutputs {
 public:
  RunOutputs() = default;
  ~RunOutputs();
  RunOutputs(const RunOutputs&) = delete;
  RunOutputs& operator=(const RunOutputs&) = delete;

  // --- Not in the tick. ---
  // Creates the log. Throws std::runtime_error or std::filesystem::filesystem_error.
  void open(const std::string& path, const core::SignalTable& signals,
            const engine::LogHeader& header);
  void name();   // gives a log that is used its name; any number of times
  void close();  // ends or removes the log; throws std::runtime_error if it could not be written
  engine::LogWriter* writer() noexcept { return writer_.get(); }

  std::unique_ptr<RunLog> log;  // writes to writer(), or nowhere
  std::unique_ptr<engine::LiveBinding> live;
  std::atomic<bool> used = false;  // set by the tick

 private:
  std::string path_;
  bool named_ = false;
  std::unique_ptr<engine::LogWriter> writer_;
};

struct ReloadCandidate {
  std::string path;
  std::shared_ptr<const behaviors::Behavior> from;  // whose place it is to take
  std::shared_ptr<const behaviors::Behavior> behavior;
  std::unique_ptr<engine::ControlLoop> own;  // nullptr for the run's first
  engine::ControlLoop* loop = nullptr;
  behaviors::TakeOverMap there, back;  // from the old behavior, and back to it
  std::unique_ptr<RunOutputs> outputs,
      way_back;  // its own, and the old one's if it is brought back
  engine::LogHeader header;
  std::int64_t waits_since = -1;     // tick; -1: it was not looked at yet
  bool complained = false;           // that it waits
  std::vector<std::string> reasons;  // against it; empty: it may take over
  std::vector<std::string> files;    // that it was loaded from, however far that went
};

// Digests of the robot's file, its bases and its model: what a reload must find as it was.
FileDigests robot_files(const behaviors::Behavior& behavior);

// Loads and checks `path` as `footfall check` does; its problems go to setup.print. What is wrong
// with it is in `reasons`.
ReloadCandidate prepare_reload(const std::string& path,
                               std::shared_ptr<const behaviors::Behavior> from,
                               const FileDigests& robot, const ReloadSetup& setup);

// The log of a run's reload, 1 being its first.
std::string reload_log(const std::string& folder, int number);

// Opens what `stage` writes to when it takes over as `continues` says. Without a log, and told so,
// if its file cannot be created: the robot steps on.
std::unique_ptr<RunOutputs> open_outputs(ReloadCandidate& stage, const LogContinuation& continues,
                                         const ReloadSetup& setup);

// For a candidate that was prepared for another behavior than the one that runs now.
void aim_reload(ReloadCandidate& candidate, std::shared_ptr<const behaviors::Behavior> from);

}  // namespace footfall::lab
