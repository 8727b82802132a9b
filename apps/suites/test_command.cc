// `footfall test`: runs scenarios as tests, in parallel, each in its own process.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/run/run_setup.h"
#include "apps/shared/commands.h"
#include "apps/shared/option_value.h"
#include "apps/shared/output_option.h"
#include "apps/shared/time_option.h"
#include "apps/suites/alike_seeds.h"
#include "core/process/file_lock.h"
#include "core/process/stop_signals.h"
#include "core/text/json_text.h"
#include "core/text/whole_file.h"
#include "core/units/units.h"
#include "lab/process/pool.h"
#include "lab/suite/bless.h"
#include "lab/suite/discovery.h"
#include "lab/suite/run.h"

namespace footfall::apps {
namespace {

namespace fs = std::filesystem;
using lab::Suite;

constexpr std::size_t kReportsOfBrokenRuns = 2;  // of a scenario

struct TestOptions {
  std::vector<std::string> paths, labels;
  int jobs = 0;
  std::string junit, json, coverage, filter, shard, timeout, seeds, program;
  std::string out = "out/test";
  bool quick = false, rerun_failed = false, keep = false, no_report = false;
  bool bless = false, yes = false;
};

// Folders in which projects keep their scenarios.
std::vector<std::string> default_folders() {
  std::vector<std::string> folders;
  for (const char* folder : {"tests/runs/regression", "behaviors"}) {
    std::error_code ignored;
    if (fs::is_directory(folder, ignored)) folders.emplace_back(folder);
  }
  return folders;
}

// `2/4`
void read_shard(const std::string& text, lab::SuiteSelection& selection) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto number = [&text](std::size_t begin, std::size_t end, int& value) {
    const auto [rest, error] = std::from_chars(text.data() + begin, text.data() + end, value);
    return error == std::errc() && rest == text.data() + end;
  };
  if (slash == text.size() || !number(0, slash, selection.shard) ||
      !number(slash + 1, text.size(), selection.shards) || selection.shard < 1 ||
      selection.shard > selection.shards) {
    throw InputError("--shard: error: expected I/N with I from 1 to N, got '" + text + "'");
  }
}

double read_timeout(const std::string& text) {
  if (text.empty()) return 0.0;
  const double time = read_time(text, "--timeout");
  if (time > 0.0) return time;
  throw InputError("--timeout: error: expected a time above 0 s, got '" + text + "'");
}

std::string session_file(const TestOptions& options) { return options.out + "/session.json"; }

// Files of the scenarios that failed in the last session.
std::vector<std::string> failed_before(const TestOptions& options) {
  std::string text;
  try {
    text = core::read_whole_file(session_file(options));
  } catch (const std::runtime_error&) {
    throw InputError(session_file(options) + ": error: no session to take failures from");
  }
  const auto session = core::parse_json(text);
  std::vector<std::string> files;
  try {
    for (const auto& scenario : session.at("scenarios")) {
      if (!scenario.at("passed").get<bool>()) files.push_back(scenario.at("file"));
    }
  } catch (const nlohmann::json::exception&) {
    throw InputError(session_file(options) + ": error: not the result of a session");
  }
  return files;
}

lab::SuiteSelection selection_of(const TestOptions& options) {
  lab::SuiteSelection selection;
  selection.filter = options.filter;
  selection.labels = options.labels;
  if (options.quick) selection.labels.emplace_back("quick");
  if (!options.shard.empty()) read_shard(options.shard, selection);
  if (!options.seeds.empty()) {
    const auto seeds = lab::parse_seeds(options.seeds);
    if (!seeds) {
      throw InputError("--seeds: error: expected seeds such as 1..20 or 1,2,5, each once, got '" +
                       options.seeds + "'");
    }
    selection.seeds = *seeds;
  }
  return selection;
}

// The scenarios to run; empty if only failures were requested and there were none.
std::vector<lab::SuiteScenario> choose(const TestOptions& options) {
  const lab::SuiteSelection selection = selection_of(options);
  std::vector<std::string> files;
  if (options.rerun_failed) {
    files = failed_before(options);
    if (files.empty()) return {};
  } else {
    std::vector<std::string> places = options.paths.empty() ? default_folders() : options.paths;
    try {
      files = lab::find_scenarios(places);
    } catch (const std::runtime_error& error) {
      throw InputError(error.what());
    }
    const std::string where = places.empty()
                                  ? "no folder tests/runs/regression or behaviors here"
                                  : fmt::format("no scenario in {}", fmt::join(places, ", "));
    if (files.empty()) {
      throw InputError("test: error: " + where + ": expected files whose first key is `scenario`");
    }
  }
  require_no_input("--junit", options.junit, files);
  require_no_input("--json", options.json, files);
  require_no_input("--coverage", options.coverage, files);
  auto scenarios = lab::load_suite(files, selection, search_path());
  if (scenarios.empty() && selection.shards == 1) {
    throw InputError(
        fmt::format("test: error: none of {} scenarios is selected: see --filter, --label, --quick",
                    files.size()));
  }
  return scenarios;
}

// A status line, rewritten in place; only on a terminal.
class StatusLine {
 public:
  StatusLine() : shown_(::isatty(STDERR_FILENO) != 0) {}
  void show(const lab::SuiteProgress& p) const {
    if (!shown_) return;
    std::string text = fmt::format("  {}/{} runs", p.done, p.runs);
    if (p.failed > 0) text += fmt::format(", {} failed", p.failed);
    for (const std::string& name : p.running) text += "  " + name;
    std::fprintf(stderr, "\r\033[K%.100s", text.c_str());
    std::fflush(stderr);
  }
  void clear() const {
    if (shown_) std::fputs("\r\033[K", stderr);
  }

 private:
  bool shown_;
};

void print_line(std::FILE* stream, const char* verdict, const Suite& suite, std::size_t s) {
  const lab::ScenarioResult& result = suite.results[s];
  const lab::SuiteScenario& scenario = suite.scenarios[s];
  fmt::print(stream, "{:<5} {:<44} {:>4} seed{} {:>7.1f} s\n", verdict, scenario.name,
             scenario.seeds.size(), scenario.seeds.size() == 1 ? " " : "s", result.wall_time);
  std::fflush(stream);
}

void print_scenario(std::FILE* stream, const Suite& suite, std::size_t s) {
  const lab::ScenarioResult& result = suite.results[s];
  print_line(stream, result.passed ? "PASS" : result.complete ? "FAIL" : "STOP", suite, s);
}

void print_failures(std::FILE* stream, const Suite& suite) {
  for (std::size_t s = 0; s < suite.scenarios.size(); ++s) {
    const std::vector<lab::SuiteFailure> failures = lab::failures_of(suite, s);
    if (failures.empty()) continue;
    fmt::print(stream, "\n{}  ({})\n", suite.scenarios[s].name, suite.scenarios[s].path);
    for (const lab::SuiteFailure& failure : failures) std::fputs(failure.text.c_str(), stream);
  }
}

void print_total(std::FILE* stream, const Suite& suite) {
  const auto passed = std::ranges::count(suite.results, true, &lab::ScenarioResult::passed);
  const auto done = std::ranges::count_if(
      suite.runs, [](const lab::SuiteRun& run) { return run.verdict != lab::Verdict::stopped; });
  fmt::print(stream, "\n{} of {} scenarios passed, {} of {} runs done in {:.1f} s{}\n", passed,
             suite.scenarios.size(), done, suite.runs.size(), suite.wall_time,
             suite.interrupted ? ": interrupted" : "");
  if (suite.coverage.empty()) return;
  fmt::print(stream, "reached: states {:.0f} %, transitions {:.0f} %, guard outcomes {:.0f} %\n",
             suite.coverage.states().percent(), suite.coverage.transitions().percent(),
             suite.coverage.guard_outcomes().percent());
}

int exit_code_of(const Suite& suite) {
  int code = kGood;
  for (const lab::ScenarioResult& result : suite.results) {
    if (!result.passed) code = kRobotFailed;
  }
  for (const lab::SuiteScenario& scenario : suite.scenarios) {
    if (!scenario.errors.empty()) code = kBadInput;
  }
  for (const lab::SuiteRun& run : suite.runs) {
    if (run.verdict == lab::Verdict::bad_input) code = std::max(code, kBadInput);
    if (run.verdict == lab::Verdict::machine) code = std::max(code, kMachineFailed);
  }
  return suite.interrupted ? std::max(code, kRobotFailed) : code;
}

void write_results(const TestOptions& options, const Suite& suite) {
  // Invalid UTF-8 (a child's stderr) is replaced instead of raising an exception.
  const auto text = [](const nlohmann::ordered_json& json) {
    return core::json_text(json, 1) + "\n";
  };
  const std::string session = text(lab::suite_json(suite));
  core::write_whole_file(session_file(options), session);
  if (!options.junit.empty()) core::write_whole_file(options.junit, lab::junit_xml(suite));
  if (!options.json.empty() && options.json != "-") core::write_whole_file(options.json, session);
  if (options.json == "-") std::fputs(session.c_str(), stdout);
  if (!options.coverage.empty())
    core::write_whole_file(options.coverage, text(suite.coverage.to_json()));
}

lab::SuiteSettings settings_of(const TestOptions& options) {
  lab::SuiteSettings settings;
  settings.program = options.program;
  if (settings.program.empty()) {
    std::error_code ignored;
    settings.program = fs::read_symlink("/proc/self/exe", ignored).string();
    if (ignored) settings.program = "footfall";
  }
  settings.out = options.out;
  settings.jobs = options.jobs > 0 ? options.jobs : lab::processor_count();
  settings.timeout = read_timeout(options.timeout);
  settings.keep = options.keep || options.bless;
  return settings;
}

// Keeps only scenarios with a golden trace, and of those only the seed of the trace.
void keep_golden(std::vector<lab::SuiteScenario>& scenarios) {
  std::erase_if(scenarios, [](const lab::SuiteScenario& s) { return s.golden.empty(); });
  for (lab::SuiteScenario& scenario : scenarios) scenario.seeds.resize(1);
  if (scenarios.empty()) throw InputError("--bless: error: none of them has a golden trace");
}

bool agreed(std::size_t count) {
  fmt::print("Make {} trace{} golden? [y/N] ", count, count == 1 ? "" : "s");
  std::fflush(stdout);
  const int answer = std::getchar();
  return answer == 'y' || answer == 'Y';
}

// A run that only left its golden trace has not failed: that is what is to be blessed.
void print_before_bless(const Suite& suite, const std::vector<lab::Blessing>& list) {
  for (std::size_t s = 0; s < suite.scenarios.size(); ++s) {
    const auto own = std::ranges::find(list, suite.scenarios[s].name, &lab::Blessing::scenario);
    if (own == list.end()) {
      print_scenario(stdout, suite, s);
      continue;
    }
    if (!own->refused.empty()) print_line(stdout, suite.interrupted ? "STOP" : "FAIL", suite, s);
    fmt::print("\n{}  ({})\n{}", own->scenario, own->to, own->text);
    if (!own->refused.empty()) fmt::print("  not blessed: {}\n", own->refused);
  }
}

// Shows the changes, asks, writes.
int bless_traces(const TestOptions& options, const Suite& suite) {
  std::vector<lab::Blessing> list = lab::blessings(suite);
  print_before_bless(suite, list);
  const auto refused = std::erase_if(list, [](const auto& b) { return !b.refused.empty(); });
  if (suite.interrupted) return kRobotFailed;
  const int code = refused > 0 ? kRobotFailed : kGood;
  if (list.empty()) {
    fmt::print("\nno golden trace changes\n");
    return code;
  }
  if (!options.yes && (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0)) {
    throw InputError("--bless: error: nobody can be asked without a terminal: give --yes");
  }
  if (!options.yes && !agreed(list.size())) return kRobotFailed;
  for (const lab::Blessing& blessing : list) {
    lab::bless(blessing);
    fmt::print("BLESS {:<44} {}\n", blessing.scenario, blessing.to);
  }
  return code;
}

// A session owns its folder; shards share one.
core::FileLock claim_folder(const TestOptions& options) {
  std::string part = options.shard;
  std::ranges::replace(part, '/', '-');
  fs::create_directories(options.out);
  core::FileLock lock(fmt::format("{}/.lock{}", options.out, part));
  if (lock.held()) return lock;
  throw InputError(
      fmt::format("--out: error: another session writes to the folder '{}'", options.out));
}

int test(const TestOptions& options) {
  lab::SuiteSettings settings = settings_of(options);
  Suite suite;
  suite.scenarios = choose(options);
  if (options.bless) keep_golden(suite.scenarios);
  std::FILE* stream = options.json == "-" ? stderr : stdout;
  if (suite.scenarios.empty()) {
    fmt::print(stream, "nothing to run: {}\n",
               options.rerun_failed ? "nothing failed in the last session" : "an empty shard");
    return kGood;
  }
  core::Diagnostics doubts;
  warn_alike_seeds(suite.scenarios, doubts);
  print_diagnostics(doubts);
  const core::FileLock lock = claim_folder(options);
  settings.stop = core::stop_on_signals();
  const StatusLine status;
  settings.progress = [&status](const lab::SuiteProgress& progress) { status.show(progress); };
  settings.scenario_done = [&](const Suite& all, std::size_t s) {
    if (options.bless) return;  // what it is, the comparison of the traces says
    status.clear();
    print_scenario(stream, all, s);
  };
  lab::announce_to_children();
  lab::run_suite(suite, settings);
  status.clear();
  if (options.bless) return bless_traces(options, suite);
  if (!options.no_report) lab::write_failure_reports(suite, settings, kReportsOfBrokenRuns);
  print_failures(stream, suite);
  print_total(stream, suite);
  if (!options.coverage.empty()) std::fputs(suite.coverage.text().c_str(), stream);
  write_results(options, suite);
  return exit_code_of(suite);
}

void add_options(CLI::App& command, TestOptions& o) {
  command.add_option(
      "SCENARIO", o.paths,
      "Scenario files, or folders of them (default: tests/runs/regression and behaviors)");
  command
      .add_option("-j,--jobs", o.jobs, "Number of parallel runs (default: one for each processor)")
      ->check(above_zero());
  command.add_option("--filter", o.filter,
                     "Only scenarios whose name or path matches, e.g. 'push*'");
  command.add_option("--label,--labels", o.labels, "Only scenarios with one of these labels");
  command.add_flag("--quick", o.quick, "Only scenarios with the label `quick`");
  command.add_option("--shard", o.shard, "I/N: the I-th of N shards of about equal duration");
  command.add_option("--seeds", o.seeds,
                     "1..20 or 1,2,5: these seeds instead of the scenarios' own");
  command.add_option(
      "--timeout", o.timeout,
      "Limit of wall time of one run, e.g. 60s (default: 60 s and 3 s for each second of it)");
  command.add_flag("--rerun-failed", o.rerun_failed,
                   "Only scenarios that failed in the last session of --out");
  command.add_option("--out", o.out, "Folder for logs of failures and the session's state")
      ->capture_default_str();
  command.add_flag("--bless", o.bless,
                   "Makes the traces of these runs the golden ones: shows what changes, then asks");
  command.add_flag("--yes", o.yes, "With --bless: does not ask")->needs("--bless");
  command.add_flag("--keep", o.keep, "Keeps the logs of runs that passed, too");
  command.add_flag("--no-report", o.no_report, "No report pages of failures");
  command.add_option("--junit", o.junit, "Writes the result as JUnit XML");
  command.add_option("--json", o.json, "Writes the whole result as JSON; - for stdout");
  command.add_option(
      "--coverage", o.coverage,
      "Lists states, transitions and conditions that no run reached; writes them as JSON");
  command.add_option("--program", o.program,
                     "Path of the footfall program for the runs (default: this one)");
  command.footer("Example: footfall test --quick -j 2 --junit out/junit.xml");
}

}  // namespace

void add_test_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TestOptions>();
  CLI::App* command = app.add_subcommand("test", "Runs scenarios as tests, side by side");
  add_options(*command, *options);
  command->callback([options, &exit_code] {
    exit_code = guarded([&] { return test(*options); }, kMachineFailed);
  });
}

}  // namespace footfall::apps
