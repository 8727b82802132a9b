// The script that submits a sweep to Slurm.
#pragma once

#include <string>

namespace footfall::apps {

struct SlurmJob {
  std::string name, out, program;
  std::string sweep_file;
  int shards = 1, jobs = 1;
  bool keep_logs = false;
  std::string template_path;  // empty: the template shipped with the program
};

// Writes OUT/slurm.sh and returns its path. Throws InputError, std::runtime_error.
std::string write_slurm_script(const SlurmJob& job);

}  // namespace footfall::apps
