// The folder of a run's files: log, summary, report, logs of reloads.
#pragma once

#include <string>
#include <vector>

#include "core/process/file_lock.h"

namespace footfall::lab {

// Where runs go that were not told where: a folder each, named by local time and behavior, and
// `latest`, a link to the newest.
inline constexpr const char* kRunsFolder = "out/run";

// A folder that belongs to one run until destruction.
class RunFolder {
 public:
  // `wanted` empty: a new folder in kRunsFolder for a run of `behavior`. Files of an earlier run in
  // the folder are removed. Throws core::MachineError if the folder cannot be made,
  // std::runtime_error if another run writes to it.
  RunFolder(const std::string& wanted, const std::string& behavior);

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  core::FileLock lock_;
};

// The folder or log itself; the newest run for a folder of runs.
std::string newest_run(const std::string& folder);

// The runs in a folder of runs, oldest first.
std::vector<std::string> run_names(const std::string& folder);
// After runs were removed: leads `latest` to the newest one that is left if its own is gone;
// without any it is removed. Throws core::MachineError if the link cannot be made.
void mend_latest(const std::string& folder);
// Whether a run is writing to it.
bool is_in_use(const std::string& folder);

}  // namespace footfall::lab
