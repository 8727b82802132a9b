// Runs the children of a suite; see run.h.
#include "lab/suite/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "core/process/machine_error.h"
#include "lab/run/utc_time.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;

// A run slower than this hangs: simulation normally runs about ten times as fast as real time.
constexpr double kTimeoutBase = 60.0, kTimeoutPerSecond = 3.0;
constexpr double kReportTimeout = 120.0;  // s

// The name converted to a folder name.
std::string folder_name(std::string name) {
  for (char& c : name) {
    if (c == '/' || c == '\\') c = '.';
  }
  return name.empty() || name.front() == '.' ? "_" + name : name;
}

void list_runs(Suite& suite, const SuiteSettings& settings) {
  suite.runs.clear();
  for (std::size_t s = 0; s < suite.scenarios.size(); ++s) {
    const SuiteScenario& scenario = suite.scenarios[s];
    if (!scenario.errors.empty()) continue;
    for (const std::uint64_t seed : scenario.seeds) {
      SuiteRun run;
      run.scenario = s;
      run.seed = seed;
      run.folder = fmt::format("{}/{}/seed-{}", settings.out, folder_name(scenario.name), seed);
      suite.runs.push_back(std::move(run));
    }
  }
}

Command command_of(const SuiteScenario& scenario, const SuiteRun& run,
                   const SuiteSettings& settings) {
  const double timeout = settings.timeout > 0.0
                             ? settings.timeout
                             : kTimeoutBase + kTimeoutPerSecond * scenario.duration;
  return {{settings.program, "run", scenario.path, "--seed", std::to_string(run.seed), "--json",
           "--quiet", "--no-report", "--log", run.folder},
          timeout};
}

void remove_folder(const std::string& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

// Removes a scenario's folder if it is empty. Only while none of its runs is active, because a run
// that is creating its own folder in it would fail.
void remove_parent(const std::string& folder) {
  std::error_code ignored;
  fs::remove(fs::path(folder).parent_path(), ignored);
}

// The first page of a run is `report.html`; a further one has its moment in its name.
std::string page_name(const SuiteRun& run, std::optional<double> moment) {
  if (run.reports.empty()) return run.folder + "/report.html";
  return run.folder +
         (moment ? fmt::format("/report-{:.3f}s.html", *moment) : "/report-whole.html");
}

Command report_command(const SuiteSettings& settings, const SuiteRun& run,
                       const RunReport& report) {
  Command command{{settings.program, "report", run.folder, "--output", report.page},
                  kReportTimeout};
  if (report.moment) {
    command.arguments.push_back(
        fmt::format("--from={:.3f}s", std::max(*report.moment - kReportBefore, 0.0)));
    command.arguments.push_back(fmt::format("--to={:.3f}s", *report.moment + kReportAfter));
  }
  return command;
}

// Counts finished runs and reports scenarios in order.
class Session {
 public:
  Session(Suite& suite, const SuiteSettings& settings) : suite_(suite), settings_(settings) {
    left_.resize(suite.scenarios.size());
    for (const SuiteRun& run : suite.runs) ++left_[run.scenario];
    suite.results.assign(suite.scenarios.size(), {});
    progress_.runs = suite.runs.size();
  }

  void started(std::size_t r) {
    progress_.running.push_back(label(r));
    tell();
  }

  void done(std::size_t r, const ProcessResult& result) {
    SuiteRun& run = suite_.runs[r];
    read_result(result, suite_.scenarios[run.scenario], run, suite_.coverage);
    if (run.verdict == Verdict::passed && !settings_.keep) remove_folder(run.folder);
    std::erase(progress_.running, label(r));
    ++progress_.done;
    progress_.failed += run.verdict != Verdict::passed && run.verdict != Verdict::stopped ? 1U : 0U;
    if (--left_[run.scenario] == 0) remove_parent(run.folder);
    tell();
    judge_finished();
  }

  void judge_finished() {
    for (; next_ < left_.size() && left_[next_] == 0; ++next_) {
      suite_.results[next_] = judge(suite_, next_);
      if (settings_.scenario_done) settings_.scenario_done(suite_, next_);
    }
  }

 private:
  std::string label(std::size_t r) const {
    const SuiteRun& run = suite_.runs[r];
    return fmt::format("{} #{}", suite_.scenarios[run.scenario].name, run.seed);
  }
  void tell() const {
    if (settings_.progress) settings_.progress(progress_);
  }

  Suite& suite_;
  const SuiteSettings& settings_;
  SuiteProgress progress_;
  std::vector<std::size_t> left_;  // unfinished runs of each scenario
  std::size_t next_ = 0;           // first scenario not yet judged
};

}  // namespace

void run_suite(Suite& suite, const SuiteSettings& settings) {
  std::error_code error;
  fs::create_directories(settings.out, error);
  if (error) {
    throw core::MachineError("cannot create the folder '" + settings.out + "': " + error.message());
  }
  suite.started = utc_now();
  const auto start = std::chrono::steady_clock::now();
  list_runs(suite, settings);
  std::vector<Command> commands;
  for (const SuiteRun& run : suite.runs) {
    remove_folder(run.folder);  // remove the log of an earlier session
    commands.push_back(command_of(suite.scenarios[run.scenario], run, settings));
  }
  Session session(suite, settings);
  session.judge_finished();
  PoolSettings pool;
  pool.jobs = settings.jobs;
  pool.stop = settings.stop;
  pool.started = [&session](std::size_t r) { session.started(r); };
  pool.done = [&session](std::size_t r, const ProcessResult& result) { session.done(r, result); };
  run_processes(commands, pool);
  suite.interrupted = settings.stop != nullptr && settings.stop->load();
  suite.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void write_failure_reports(Suite& suite, const SuiteSettings& settings, std::size_t broken) {
  std::vector<Command> commands;
  std::vector<std::pair<SuiteRun*, std::size_t>> of;  // index into its reports
  for (std::size_t s = 0; s < suite.scenarios.size(); ++s) {
    std::size_t errors = 0;
    for (const SuiteFailure& failure : failures_of(suite, s)) {
      if (!failure.run || (failure.error && errors++ >= broken)) continue;
      SuiteRun& run = suite.runs[*failure.run];
      std::error_code ignored;
      if (report_of(run, failure.moment) != nullptr ||
          !fs::exists(run.folder + "/log.mcap", ignored))
        continue;
      run.reports.push_back({failure.moment, page_name(run, failure.moment)});
      of.emplace_back(&run, run.reports.size() - 1);
      commands.push_back(report_command(settings, run, run.reports.back()));
    }
  }
  PoolSettings pool;
  pool.jobs = settings.jobs;
  pool.stop = settings.stop;
  std::vector<bool> written(commands.size());
  pool.done = [&](std::size_t i, const ProcessResult& result) {
    std::error_code ignored;
    const auto& [run, report] = of[i];
    written[i] = result.end == ProcessEnd::exited && fs::exists(run->reports[report].page, ignored);
  };
  run_processes(commands, pool);
  for (std::size_t i = of.size(); i-- > 0;) {
    const auto& [run, report] = of[i];
    if (!written[i]) run->reports.erase(run->reports.begin() + static_cast<std::ptrdiff_t>(report));
  }
}

}  // namespace footfall::lab
