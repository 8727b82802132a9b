// A suite: scenarios run as tests, and their results. One run is one scenario with one seed;
// expectations are judged over all seeds of a scenario.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/judge/coverage.h"
#include "lab/judge/result.h"
#include "lab/scenario/description.h"

namespace footfall::lab {

// The data of an expectation that the runner needs.
struct SuiteExpectation {
  std::string text;   // as written, with its time window
  std::string place;  // file:line:column
  double part = 1.0;  // fraction of seeds in which it must hold
};

struct SuiteScenario {
  std::string path;  // path under which it was found
  std::string name;  // unique in the suite
  std::vector<std::string> labels;
  std::vector<std::uint64_t> seeds;
  double duration = 0.0;  // s of simulated time
  std::vector<SuiteExpectation> expectations;
  bool scripted = false;  // has a script
  std::string golden;     // path of the golden trace for the first seed; empty: none
  std::string errors;     // load errors; if not empty, the scenario is not run
  std::shared_ptr<const CoverageMap> map;             // coverage map of its behavior
  std::shared_ptr<const ScenarioDescription> source;  // without its behavior; null after errors
};

enum class Verdict : std::uint8_t {
  passed,
  failed,      // an expectation did not hold, or the robot fell
  crashed,     // died of a signal
  timed_out,   // killed after the time-out
  bad_input,   // error in the scenario or in a file that it names
  bad_output,  // the run's output is malformed
  machine,     // machine or backend failure
  stopped,     // killed or not started because of Ctrl-C
};
const char* verdict_name(Verdict verdict);

// Result of one expectation in one run.
struct Observation {
  bool passed = false;
  std::string value;         // formatted; may be empty
  std::optional<double> at;  // s, time of the decision
  std::int64_t tick = -1;    // -1: unknown
  std::string state;         // active state at that time
  std::string why;
};

// The page of a run around one moment.
struct RunReport {
  std::optional<double> moment;  // s; nullopt: the whole run
  std::string page;
};

struct SuiteRun {
  std::size_t scenario = 0;  // into Suite::scenarios
  std::uint64_t seed = 0;
  Verdict verdict = Verdict::stopped;
  std::string end;                         // reason for the end of the run, as reported by it
  std::string why;                         // why there is no result; empty if there is one
  std::vector<ScenarioFailure> failures;   // of its result, beside the expectations
  std::string error_tail;                  // the last lines of stderr
  std::vector<Observation> observations;   // one for each expectation; empty without a result
  double wall_time = 0.0, cpu_time = 0.0;  // s
  std::string folder;                      // folder of its log
  std::vector<RunReport> reports;
};

// Result of an expectation over all seeds.
struct Judgement {
  bool passed = false;
  std::size_t held = 0, of = 0;    // number of runs in which it held, and of runs judged
  std::vector<std::size_t> broke;  // runs (indices into Suite::runs) in which it did not hold
};

struct ScenarioResult {
  bool passed = false;
  bool complete = false;              // all seeds were run
  std::vector<Judgement> judgements;  // one for each expectation
  std::vector<std::size_t> broken;    // runs that crashed, hung, fell, left the golden trace, ...
  double wall_time = 0.0;             // s, sum over its runs
};

struct Suite {
  std::vector<SuiteScenario> scenarios;
  std::vector<SuiteRun> runs;           // by scenario, then by seed
  std::vector<ScenarioResult> results;  // one for each scenario
  Coverage coverage;
  double wall_time = 0.0;  // s
  std::string started;     // 2026-01-31T12:00:00, UTC
  bool interrupted = false;
};

// One failure of a scenario: of an expectation over all seeds, of all runs that failed alike beside
// the expectations, or of one run that has no result.
struct SuiteFailure {
  std::string type;             // expectation, end, script, golden; of an error its Verdict's name
  bool error = false;           // it could not be run, or not to its end
  std::size_t expectation = 0;  // of type `expectation`
  std::optional<std::size_t> run;  // the run that is described
  std::optional<double> moment;    // of its failure, s
  std::string place;               // FILE:LINE:COLUMN, or FILE
  std::string message;             // one line
  std::string text;  // with expected and actual values; a few lines, each with line end
};
std::vector<SuiteFailure> failures_of(const Suite& suite, std::size_t scenario);
// Whether some run of a scenario has a result.
bool has_result(const Suite& suite, std::size_t scenario);
// The page that shows a run at `moment`; nullptr if there is none.
const RunReport* report_of(const SuiteRun& run, std::optional<double> moment);
// A page shows so much before and after its moment, s.
constexpr double kReportBefore = 1.5, kReportAfter = 0.5;
// The shell command that repeats one run.
std::string rerun_command(const Suite& suite, const SuiteRun& run);

// JUnit XML: a test suite for each scenario, with a test case for what could not be run (`runs`),
// for the ends of the runs, the script and the golden trace, and for each expectation over all
// seeds.
std::string junit_xml(const Suite& suite);
nlohmann::ordered_json suite_json(const Suite& suite);

}  // namespace footfall::lab
