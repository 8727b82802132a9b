// A suite: scenarios that are run as tests, and what came of them. One run is one scenario with one
// seed; expectations are judged over all seeds of a scenario.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/judge/coverage.h"

namespace footfall::lab {

// An expectation as the runner must know it.
struct SuiteExpectation {
  std::string text;   // as written, with its window
  std::string place;  // file:line:column
  double part = 1.0;  // of the seeds in which it must hold
};

struct SuiteScenario {
  std::string path;  // as it was found
  std::string name;  // unique in the suite
  std::vector<std::string> labels;
  std::vector<std::uint64_t> seeds;
  double duration = 0.0;  // s of simulated time
  std::vector<SuiteExpectation> expectations;
  std::string golden;  // path of the trace that the first seed must follow; empty: none
  std::string errors;  // of the file; if there are any nothing is run
  std::shared_ptr<const CoverageMap> map;  // of its behavior
};

enum class Verdict : std::uint8_t {
  passed,
  failed,      // an expectation did not hold, or the robot fell
  crashed,     // died of a signal
  timed_out,   // killed after the time-out
  bad_input,   // the scenario or what it names is wrong
  bad_output,  // the run said nothing that can be understood
  machine,     // the machine or the backend failed
  stopped,     // by Ctrl-C, or not begun because of it
};
const char* verdict_name(Verdict verdict);

// What became of one expectation in one run.
struct Observation {
  bool passed = false;
  std::string value;         // as text, may be empty
  std::optional<double> at;  // s, when it was decided
  std::int64_t tick = -1;    // -1: unknown
  std::string state;         // active then
  std::string why;
};

struct SuiteRun {
  std::size_t scenario = 0;  // into Suite::scenarios
  std::uint64_t seed = 0;
  Verdict verdict = Verdict::stopped;
  std::string end;                         // how the run ended, by its own words
  std::string why;                         // of a failure that is not an expectation's
  std::string error_tail;                  // the last lines of stderr
  std::vector<Observation> observations;   // one for each expectation; none if it gave no result
  double wall_time = 0.0, cpu_time = 0.0;  // s
  std::string folder;                      // of its log
  std::string report;                      // path of the page; empty: none
};

// An expectation over the seeds.
struct Judgement {
  bool passed = false;
  std::size_t held = 0, of = 0;    // runs in which it held, of those that were judged
  std::vector<std::size_t> broke;  // runs (into Suite::runs) in which it did not hold
};

struct ScenarioResult {
  bool passed = false;
  bool complete = false;              // every seed was run
  std::vector<Judgement> judgements;  // one for each expectation
  std::vector<std::size_t> broken;    // runs that crashed, hung, fell, ...: why says what
  double wall_time = 0.0;             // s, of its runs together
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

// What failed, was expected and happened; a few lines, each ended. Nothing for a scenario that
// passed.
std::string failure_text(const Suite& suite, std::size_t scenario);
// The text as UTF-8 without control characters but tabs and ends of lines; `?` for all else: what a
// child says may be anything.
std::string printable(const std::string& text);
// The command that does one run again, for a shell.
std::string rerun_command(const Suite& suite, const SuiteRun& run);
// The time at which a run went wrong, if it is known, s.
std::optional<double> moment_of(const SuiteRun& run);

// JUnit's XML: a test suite for each scenario, in it a test case for its runs as such, and one for
// each expectation over all seeds.
std::string junit_xml(const Suite& suite);
nlohmann::ordered_json suite_json(const Suite& suite);

}  // namespace footfall::lab
