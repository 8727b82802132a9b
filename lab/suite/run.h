// Runs a suite: one child process for each scenario and seed, and judges what they say.
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
  std::string program;  // that runs a scenario: `PROGRAM run FILE --seed N ...`
  std::string out;      // folder of logs: OUT/NAME/seed-N
  int jobs = 1;
  double timeout = 0.0;                     // s of wall time; 0: by the scenario's duration
  bool keep = false;                        // keeps the logs of runs that passed
  const std::atomic<bool>* stop = nullptr;  // set by Ctrl-C
  std::function<void(const SuiteProgress&)> progress;
  // Called in the order of the scenarios, as soon as all before it are done, too.
  std::function<void(const Suite&, std::size_t)> scenario_done;
};

// Fills runs, results and coverage of a suite whose scenarios are loaded. Throws std::runtime_error
// if the folder of logs cannot be made.
void run_suite(Suite& suite, const SuiteSettings& settings);

// What a child's end and output amount to; observations and verdict of `run` are filled, its
// coverage is added to `coverage`.
void read_result(const ProcessResult& result, const SuiteScenario& scenario, SuiteRun& run,
                 Coverage& coverage);
// Over all runs of a scenario.
ScenarioResult judge(const Suite& suite, std::size_t scenario);

// Writes the report of the first failures of each scenario, around the moment, in children too: at
// most `each` of a scenario.
void write_failure_reports(Suite& suite, const SuiteSettings& settings, std::size_t each);

}  // namespace footfall::lab
