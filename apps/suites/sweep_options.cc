// CLI11 declarations of `footfall sweep`; see sweep_options.h.
#include "apps/suites/sweep_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "apps/run/run_setup.h"
#include "apps/shared/option_value.h"
#include "lab/process/pool.h"

namespace footfall::apps {
namespace {

// Options with an equivalent in sweep files.
void add_plan_options(CLI::App& command, SweepCommandOptions& o) {
  lab::SweepArguments& p = o.plan;
  const auto list = [&](const char* name, std::vector<std::string>& to, const char* doc) {
    command.add_option(name, to, doc)->expected(1)->take_all()->group("What is run");
  };
  const auto one = [&](const char* name, std::string& to, const char* doc) {
    command.add_option(name, to, doc)->group("What is run");
  };
  list("--vary", p.vary, "NAME=130ms..160ms:4 or NAME=[200, 220]: values, all combinations");
  list("--zip", p.zip, "NAME=[1, 2]: lists of equal length, combined element by element");
  list("--sample", p.sample,
       "NAME=uniform(1, 2), log_uniform(1, 2), normal(1.5, 0.1): random values");
  one("--count", p.count, "Number of samples (default 20)");
  one("--sample-seed", p.sample_seed, "Seed of the samples (default 1)");
  one("--method", p.method, "random or latin_hypercube");
  one("--seeds", p.seeds, "100..119 or 1,2,5: seeds, one run each");
  one("--faults", p.faults,
      "none,mocap.dropout@5s:2s: injected faults, one run each (default: from 2 s to the end)");
  one("--worlds,--world", p.worlds, "flat,slippery: worlds, one run each");
  one("--robot", p.robot, "Robot, instead of the behavior's own");
  one("--for", p.duration, "Duration of a run (default 20 s, or the scenario's)");
  one("--timeout", p.timeout, "Limit of wall time of one run");
  list("--figure", p.figures, "Figure of merit in the report, e.g. error.pitch.max");
}

}  // namespace

void add_sweep_options(CLI::App& command, SweepCommandOptions& o) {
  command.add_option("WHAT", o.plan.what, "Sweep file, scenario, or behavior (file or name)");
  add_plan_options(command, o);
  command.add_option("--out", o.out, "Folder of the results (default: out/sweep/NAME)");
  command
      .add_option("-j,--jobs", o.jobs, "Number of parallel runs (default: one for each processor)")
      ->check(above_zero());
  command.add_option("--shard", o.shard_text,
                     "I/N: every N-th run from the I-th on, stored in its own file");
  command.add_flag("--extend", o.extend,
                   "Continues after a change of the plan; keeps completed runs");
  command.add_flag("--keep-logs", o.keep_logs, "Keeps the logs of runs that did not pass");
  command.add_flag("--no-report", o.no_report, "No report page at the end");
  command.add_flag("--list", o.list, "Only prints the command of each run");
  command.add_option("--save", o.save, "Only writes the equivalent sweep file");
  command.add_option("--merge", o.merge,
                     "Merges the shards in this folder, then writes the report");
  command.add_option("--report", o.report, "Writes the report of the results in this folder");
  command.add_option("--csv", o.csv, "Writes the results in this folder as sweep.csv");
  command.add_option("--slurm", o.slurm, "Writes a script for Slurm: a job array of N shards")
      ->check(above_zero());
  command.add_option("--template", o.slurm_template,
                     "Template of that script (default: lab/slurm/array.sh)");
  command.add_option("--program", o.program,
                     "Path of the footfall program for the runs (default: this one)");
  command.footer(
      "Repeating a stopped or killed command continues it.\n"
      "Example: footfall sweep balance_best --vary lift_time=130ms..160ms:4 --seeds 1..10 --for "
      "10s");
}

void finish_sweep_options(SweepCommandOptions& o) {
  const lab::SweepArguments& p = o.plan;
  if (p.sample.empty() && !(p.count + p.sample_seed + p.method).empty()) {
    throw InputError(
        "--count: error: --count, --sample-seed, --method say how to draw: give --sample");
  }
  if (!o.shard_text.empty()) {
    int used = 0;
    const bool read =
        std::sscanf(o.shard_text.c_str(), "%d/%d%n", &o.shard, &o.shards, &used) == 2;  // NOLINT
    if (!read || used != static_cast<int>(o.shard_text.size()) || o.shard < 1 ||
        o.shard > o.shards || o.shards > 100'000) {
      throw InputError("--shard: error: expected I/N with I from 1 to N, got '" + o.shard_text +
                       "'");
    }
    if (o.extend) {
      throw InputError(
          "--extend: error: not with --shard, where a run may have moved to another shard: merge "
          "first, then extend the whole");
    }
  }
  if (o.jobs == 0) o.jobs = lab::processor_count();
  if (o.program.empty()) {
    std::error_code error;
    o.program = std::filesystem::read_symlink("/proc/self/exe", error).string();
    o.own_program = !error;
    if (error) o.program = "footfall";
  }
}

}  // namespace footfall::apps
