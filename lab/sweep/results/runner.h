// Runs what a sweep has left to do: one child process a run, its result in the store at once.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "lab/process/pool.h"
#include "lab/sweep/results/store.h"

namespace footfall::lab {

struct SweepProgress {
  std::size_t done = 0;                // of this session
  std::size_t to_do = 0;               // at its start
  std::size_t before = 0;              // done in earlier sessions
  std::size_t failed = 0, broken = 0;  // of this session: by the robot; by the program or its input
  double elapsed = 0.0;                // s
  double left = 0.0;                   // s, estimated; 0 before the first run is done
};

struct SweepSettings {
  std::string program;              // that runs: `PROGRAM run ... --json --no-log`
  std::string folder;               // of derived files
  std::vector<std::string> worlds;  // path of each of the sweep's worlds
  int jobs = 1;
  std::string logs;                         // folder for the logs of what did not pass; empty: none
  const std::atomic<bool>* stop = nullptr;  // set by Ctrl-C
  std::function<void(const SweepProgress&)> progress;
};

// Throws std::runtime_error if a file cannot be written, SweepStoreError.
SweepProgress run_sweep(const SweepDescription& sweep, SweepStore& store,
                        const SweepSettings& settings);

// What a child's end and output amount to.
SweepResult read_sweep_result(const ProcessResult& process);
// Ids of a shard: every `shards`-th, so that all have the same mix.
std::vector<std::size_t> shard_ids(std::size_t runs, int shard, int shards);

}  // namespace footfall::lab
