// A changed behavior on its way into a run: loaded and checked beside it, with a control loop of
// its own, so that taking over costs the run nothing but a copy.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "behaviors/compiled/take_over_map.h"
#include "behaviors/loader.h"
#include "core/diagnostics/diagnostics.h"
#include "engine/log/writer.h"
#include "engine/tick/control_loop.h"
#include "hal/hardware.h"
#include "lab/run/run_log.h"

namespace footfall::lab {

// What a run gives for its reloads.
struct ReloadSetup {
  hal::Hardware* hardware = nullptr;
  behaviors::LoadOptions load;  // as the first behavior was loaded
  LogSource source;             // likewise; its settings are those of every control loop
  std::string folder;           // of the run's log; empty: none is written
  // Every problem of a file, as it is found; from the thread that loads.
  std::function<void(const core::Diagnostics&)> print;
  // One line on what became of a reload, from any thread.
  std::function<void(const std::string&)> tell;
};

// Files by path, each with a digest of its content.
using FileDigests = std::map<std::string, std::uint64_t>;

struct ReloadCandidate {
  std::string path;
  std::shared_ptr<const behaviors::Behavior> from;  // whose place it is to take
  std::shared_ptr<const behaviors::Behavior> behavior;
  std::unique_ptr<engine::ControlLoop> loop;
  behaviors::TakeOverMap there, back;  // from the old behavior, and back to it
  engine::LogHeader header;
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

// For a candidate that was prepared for another behavior than the one that runs now.
void aim_reload(ReloadCandidate& candidate, std::shared_ptr<const behaviors::Behavior> from);

}  // namespace footfall::lab
