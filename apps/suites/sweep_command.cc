// `footfall sweep`: many runs of one behavior or scenario, resumable, with a report.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "apps/run/run_setup.h"
#include "apps/shared/commands.h"
#include "apps/shared/output_option.h"
#include "apps/suites/sweep_options.h"
#include "apps/suites/sweep_setup.h"
#include "apps/suites/sweep_slurm.h"
#include "core/text/printable.h"
#include "core/text/whole_file.h"
#include "core/yaml_text/write.h"
#include "lab/process/pool.h"
#include "lab/run/version.h"
#include "lab/suite/discovery.h"
#include "lab/sweep/plan/derived_files.h"
#include "lab/sweep/results/report.h"
#include "lab/sweep/results/runner.h"

namespace footfall::apps {
namespace {

namespace fs = std::filesystem;

// A sweep, and its file if it was loaded from one.
struct Loaded {
  PreparedSweep prepared;
  core::YamlNode tree;  // built from the command line
  std::string file;     // empty: the command line
};

// Throws InputError after printing the problems.
Loaded load(const SweepCommandOptions& options) {
  if (options.plan.what.empty()) {
    throw InputError("sweep: error: expected a sweep file, a scenario or a behavior");
  }
  core::Diagnostics diagnostics;
  Loaded loaded;
  lab::SweepDescription sweep;
  const std::string key = lab::first_key(options.plan.what);
  const lab::SweepOptions how = {search_path()};
  if (key == "sweep") {
    if (!options.given.empty()) {
      throw InputError(options.given.front() +
                       ": error: a sweep file says that itself: " + options.plan.what);
    }
    loaded.file = options.plan.what;
    sweep = lab::load_sweep(loaded.file, how, diagnostics);
  } else {
    loaded.tree = lab::sweep_tree(options.plan, key == "scenario", diagnostics);
    sweep = lab::read_sweep(loaded.tree, options.plan.what, how, diagnostics);
  }
  loaded.prepared = prepare_sweep(std::move(sweep), diagnostics);
  print_diagnostics(diagnostics);
  if (diagnostics.has_errors()) throw InputError("");
  return loaded;
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

lab::SweepIdentity identity_of(const SweepCommandOptions& options, const PreparedSweep& prepared) {
  lab::SweepIdentity id;
  id.plan = lab::plan_digest(prepared.sweep);
  id.inputs = digest_of_files(prepared.inputs);
  std::error_code ignored;
  id.program = fs::is_regular_file(options.program, ignored) ? digest_of_files({options.program})
                                                             : std::string("unknown");
  id.version = lab::kVersion;
  id.host = host_name();
  id.description = lab::describe_sweep(prepared.sweep);
  id.runs = lab::run_count(prepared.sweep);
  id.shard = options.shard, id.shards = options.shards;
  return id;
}

std::string clock_text(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string progress_text(const lab::SweepProgress& p) {
  std::string text = fmt::format("{}/{} runs", p.done, p.to_do);
  if (p.before > 0) text += fmt::format(" ({} done before)", p.before);
  text += fmt::format(", {} failed", p.failed);
  if (p.broken > 0) text += fmt::format(", {} broken", p.broken);
  return text;
}

void show_progress(const lab::SweepProgress& p) {
  const std::string left = p.done > 0 ? ", " + clock_text(p.left) + " left" : "";
  std::fprintf(stderr, "\r\033[K  %.100s%s", progress_text(p).c_str(), left.c_str());
  std::fflush(stderr);
}

void write_report(const std::string& folder, const lab::SweepTable& table) {
  const std::string path = folder + "/report.html";
  core::write_whole_file(path, lab::sweep_report_html(table));
  fmt::print("  report       {}\n", path);
}

bool is_broken(const lab::SweepRow& row) { return row.result.status > lab::SweepStatus::failed; }

// The reason of the first broken run, which is often that of all of them, and how to see it.
void print_first_broken(const lab::SweepTable& table) {
  const auto broken = std::ranges::find_if(table.rows, is_broken);
  if (broken == table.rows.end()) return;
  fmt::print("  broken       run {}: {}\n", broken->id, core::on_one_line(broken->result.why));
  std::string_view rest = broken->result.error_tail;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    fmt::print("               {}\n", rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  fmt::print("    rerun      {}\n", broken->command);
}

// 0 if all runs are done and none is broken.
int exit_code_of(const lab::SweepTable& table) {
  const bool all = table.rows.size() == table.identity.runs;
  const bool pending = std::ranges::any_of(table.rows, [](const lab::SweepRow& row) {
    return row.result.status == lab::SweepStatus::pending;
  });
  const bool good = all && !pending && std::ranges::none_of(table.rows, is_broken);
  return good ? kGood : kRobotFailed;
}

int merge(const std::string& folder, bool report) {
  const lab::SweepStore store(lab::merge_shards(folder));
  const lab::SweepTable table = store.read();
  const std::size_t pending = store.counts().front();
  fmt::print("{} of {} runs are here\n", table.rows.size() - pending, table.identity.runs);
  print_first_broken(table);
  fmt::print("  results      {}\n", lab::store_path(folder, 1, 1));
  if (report) write_report(folder, table);
  return exit_code_of(table);
}

lab::SweepTable read_folder(const std::string& folder) {
  const std::string path = lab::store_path(folder, 1, 1);
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    throw InputError(path + ": error: no results here; shards are joined by --merge");
  }
  return lab::SweepStore(path, lab::SweepStore::Access::read).read();
}

int list_runs(const PreparedSweep& prepared, const std::string& out) {
  lab::SweepFiles files(prepared.sweep, out + "/files", prepared.worlds);
  for (std::size_t id = 0; id < lab::run_count(prepared.sweep); ++id) {
    const lab::SweepRun run = lab::run_of(prepared.sweep, id);
    fmt::print("{}\n", lab::shell_line(
                           lab::command_of("footfall", prepared.sweep, run, files.target(run))));
  }
  return kGood;
}

int write_slurm(const SweepCommandOptions& options, const Loaded& loaded, const std::string& out) {
  fs::create_directories(out);
  SlurmJob job{loaded.prepared.sweep.name,
               out,
               options.program,
               loaded.file,
               options.slurm,
               options.jobs,
               options.keep_logs,
               options.slurm_template};
  if (job.sweep_file.empty()) {
    job.sweep_file = out + "/sweep.yaml";
    core::write_whole_file(job.sweep_file, core::to_yaml(loaded.tree));
  }
  fmt::print("bash {}\n", write_slurm_script(job));
  return kGood;
}

int run(const SweepCommandOptions& options, const Loaded& loaded, const std::string& out) {
  const PreparedSweep& prepared = loaded.prepared;
  fs::create_directories(out);
  lab::SweepStore store(lab::store_path(out, options.shard, options.shards));
  const lab::SweepIdentity identity = identity_of(options, prepared);
  if (!store.empty() && store.identity().program != identity.program) {
    std::fputs("warning: earlier runs were made by another build of footfall\n", stderr);
  }
  store.begin(prepared.sweep, identity,
              lab::shard_ids(identity.runs, options.shard, options.shards), options.extend);
  lab::SweepSettings settings;
  // This executable, even if it is rebuilt during the sweep.
  settings.program =
      options.own_program ? fmt::format("/proc/{}/exe", ::getpid()) : options.program;
  settings.folder = out + "/files";
  settings.worlds = prepared.worlds;
  settings.jobs = options.jobs;
  if (options.keep_logs) settings.logs = out + "/logs";
  settings.stop = core::stop_on_signals();
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  if (terminal) settings.progress = show_progress;
  lab::announce_to_children();
  const lab::SweepProgress progress = lab::run_sweep(prepared.sweep, store, settings);
  if (terminal) std::fputs("\r\033[K", stderr);
  fmt::print("{} in {}{}\n", progress_text(progress), clock_text(progress.elapsed),
             progress.done < progress.to_do ? ": stopped; repeat the command to continue" : "");
  fmt::print("  results      {}\n", lab::store_path(out, options.shard, options.shards));
  const lab::SweepTable table = store.read();
  print_first_broken(table);
  if (!options.no_report && options.shards == 1) write_report(out, table);
  if (options.shards == 1) return exit_code_of(table);
  return progress.broken > 0 || progress.done < progress.to_do ? kRobotFailed : kGood;
}

int sweep(const SweepCommandOptions& options) {
  if (!options.merge.empty()) return merge(options.merge, !options.no_report);
  if (!options.report.empty() || !options.csv.empty()) {
    if (!options.report.empty()) write_report(options.report, read_folder(options.report));
    if (options.csv.empty()) return kGood;
    core::write_whole_file(options.csv + "/sweep.csv", lab::sweep_csv(read_folder(options.csv)));
    fmt::print("  table        {}/sweep.csv\n", options.csv);
    return kGood;
  }
  const Loaded loaded = load(options);
  const std::string out =
      options.out.empty() ? "out/sweep/" + loaded.prepared.sweep.name : options.out;
  if (!options.save.empty()) {
    if (!loaded.file.empty()) throw InputError("--save: error: it is a sweep file already");
    require_no_input("--save", options.save, {options.plan.what});
    core::write_whole_file(options.save, core::to_yaml(loaded.tree));
    return kGood;
  }
  if (options.list) return list_runs(loaded.prepared, out);
  if (options.slurm > 0) return write_slurm(options, loaded, out);
  return run(options, loaded, out);
}

}  // namespace

void add_sweep_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SweepCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Runs a behavior or scenario with many parameters, seeds, faults and worlds");
  add_sweep_options(*command, *options);
  command->callback([command, options, &exit_code] {
    for (const CLI::Option* option : command->get_options()) {
      if (option->count() > 0 && option->get_group() == "What is run") {
        options->given.push_back(option->get_name());
      }
    }
    const auto work = [&] {
      finish_sweep_options(*options);
      try {
        return sweep(*options);
      } catch (const lab::SweepStoreError& error) {
        throw InputError(std::string("sweep: error: ") + error.what());
      }
    };
    exit_code = guarded(work, kMachineFailed);
  });
}

}  // namespace footfall::apps
