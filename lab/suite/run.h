// Runs a suite: one child process for each scenario and seed, and judges their results.
#pragma once

#include <atomic>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/process/pool.h"
#include "lab/suite/suite.h"

namespace footfall::lab {

struct SuiteProgress {
  std::size_t done = 0, runs = 0, failed = 0;
  std::vector<std::string> running;  // names with seeds
};

struct SuiteSettings {
  std::string program;  // executable; called as `PROGRAM run FILE --seed N ...`
  std::string out;      // folder of the logs: OUT/NAME/seed-N
  int jobs = 1;
  double timeout = 0.0;                     // s of wall time; 0: from the scenario's duration
  bool keep = false;                        // keep the logs of passed runs
  const std::atomic<bool>* stop = nullptr;  // set by Ctrl-C
  std::function<void(const SuiteProgress&)> progress;
  // Called in scenario order, once the scenario and all earlier ones are done.
  std::function<void(const Suite&, std::size_t)> scenario_done;
};

// Fills runs, results and coverage of a suite with loaded scenarios. Throws std::runtime_error if
// the folder of the logs cannot be made.
void run_suite(Suite& suite, const SuiteSettings& settings);

// Interprets a child's exit and output; fills observations and verdict of `run` and adds its
// coverage to `coverage`.
void read_result(const ProcessResult& result, const SuiteScenario& scenario, SuiteRun& run,
                 Coverage& coverage);
// Judges the expectations over all runs of a scenario.
ScenarioResult judge(const Suite& suite, std::size_t scenario);

// Writes a report page of the time around each failure, also in child processes; failures of a run
// that are near each other share one. Of runs without a result at most `broken` a scenario.
void write_failure_reports(Suite& suite, const SuiteSettings& settings, std::size_t broken);

}  // namespace footfall::lab
