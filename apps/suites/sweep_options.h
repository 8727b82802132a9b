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
  std::vector<std::string> given;  // plan options that were written, `--vary`
  std::string out;                 // folder; empty: out/sweep/NAME
  int jobs = 0;                    // 0: one for each processor
  std::string shard_text;
  int shard = 1, shards = 1;
  bool extend = false, keep_logs = false, no_report = false, list = false;
  std::string save;                // writes the sweep file that says the same
  std::string merge, report, csv;  // folders: no runs, only that
  int slurm = 0;                   // shards; 0: no
  std::string slurm_template;
  std::string program;
  bool own_program = false;  // it is this one
};

void add_sweep_options(CLI::App& command, SweepCommandOptions& options);
// Derives what depends on the text. Throws InputError.
void finish_sweep_options(SweepCommandOptions& options);

}  // namespace footfall::apps
