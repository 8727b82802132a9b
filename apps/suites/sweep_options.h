// The options of `footfall sweep`.
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/plan/loader.h"

namespace CLI {
class App;
}

namespace footfall::apps {

struct SweepCommandOptions {
  lab::SweepArguments plan;
  std::vector<std::string> given;  // plan options given, e.g. `--vary`
  std::string out;                 // folder; empty: out/sweep/NAME
  int jobs = 0;                    // 0: one for each processor
  std::string shard_text;
  int shard = 1, shards = 1;
  bool extend = false, keep_logs = false, no_report = false, list = false;
  std::string save;                // path to which the equivalent sweep file is written
  std::string merge, report, csv;  // folders; if set, no runs
  int slurm = 0;                   // number of shards; 0: no Slurm
  std::string slurm_template;
  std::string program;
  bool own_program = false;  // `program` is this executable
};

void add_sweep_options(CLI::App& command, SweepCommandOptions& options);
// Sets options that depend on others. Throws InputError.
void finish_sweep_options(SweepCommandOptions& options);

}  // namespace footfall::apps
