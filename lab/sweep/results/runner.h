// Executes the pending runs of a sweep: one child process a run; results are stored immediately.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "lab/process/pool.h"
#include "lab/sweep/results/store.h"

namespace footfall::lab {

struct SweepProgress {
  std::size_t done = 0;                // runs done in this session
  std::size_t to_do = 0;               // runs pending at its start
  std::size_t before = 0;              // done in earlier sessions
  std::size_t failed = 0, broken = 0;  // of this session; broken: program or input error
  double elapsed = 0.0;                // s
  double left = 0.0;                   // s, estimated remaining; 0 before the first run is done
};

struct SweepSettings {
  std::string program;              // executable; called as `PROGRAM run ... --json --no-log`
  std::string folder;               // folder of derived files
  std::vector<std::string> worlds;  // path of each of the sweep's worlds
  int jobs = 1;
  std::string logs;  // folder for the logs of failed and broken runs; empty: none
  const std::atomic<bool>* stop = nullptr;  // set by Ctrl-C
  std::function<void(const SweepProgress&)> progress;
};

// Throws SweepStoreError, or std::runtime_error if a file cannot be written.
SweepProgress run_sweep(const SweepDescription& sweep, SweepStore& store,
                        const SweepSettings& settings);

// Interprets a child's exit and output.
SweepResult read_sweep_result(const ProcessResult& process);
// Run ids of a shard: every `shards`-th run, so that all shards have the same mix.
std::vector<std::size_t> shard_ids(std::size_t runs, int shard, int shards);

}  // namespace footfall::lab
