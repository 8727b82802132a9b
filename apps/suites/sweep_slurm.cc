// Writes the script for Slurm; see sweep_slurm.h.
#include "apps/suites/sweep_slurm.h"

#include <filesystem>

#include "apps/run/run_setup.h"
#include "apps/shared/commands.h"
#include "core/text/whole_file.h"
#include "lab/process/pool.h"
#include "lab/report/page.h"

namespace footfall::apps {
namespace {

namespace fs = std::filesystem;

std::string find_template(const std::string& given) {
  if (!given.empty()) return given;
  for (const std::string& folder : search_path()) {
    const std::string path = folder + "/lab/slurm/array.sh";
    std::error_code error;
    if (fs::is_regular_file(path, error)) return path;
  }
  throw InputError("--slurm: error: no lab/slurm/array.sh in the search path: give --template");
}

// The name restricted to characters that Slurm allows in job names.
std::string job_name(std::string name) {
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') c = '_';
  }
  return name.empty() ? "sweep" : name;
}

}  // namespace

std::string write_slurm_script(const SlurmJob& job) {
  std::string text;
  try {
    text = core::read_whole_file(find_template(job.template_path));
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("--template: error: ") + error.what());
  }
  const std::string out = fs::absolute(job.out).lexically_normal().string();
  if (out.find_first_of(" \t\n\"'\\") != std::string::npos) {
    throw InputError("--out: error: Slurm takes no folder with blanks or quotes: '" + out + "'");
  }
  const std::string path = out + "/slurm.sh";
  std::vector<std::string> command = {job.program, "sweep", fs::absolute(job.sweep_file).string(),
                                      "--out",     out,     "--no-report"};
  if (job.keep_logs) command.emplace_back("--keep-logs");
  const std::string script = lab::fill_template(
      text, {{"name", job_name(job.name)},
             {"script", path},
             {"folder", lab::shell_line({fs::current_path().string()})},
             {"out", out},
             {"shards", std::to_string(job.shards)},
             {"jobs", std::to_string(job.jobs)},
             {"command", lab::shell_line(command)},
             {"merge", lab::shell_line({job.program, "sweep", "--merge", out})}});
  core::write_whole_file(path, script);
  return path;
}

}  // namespace footfall::apps
