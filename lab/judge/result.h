// What one run of a scenario with one seed came to, and its JSON: all that a test runner needs to
// know of the process that ran it.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "behaviors/machine/machine.h"
#include "lab/scenario/description.h"

namespace footfall::lab {

// One expectation in one run. The place is where it was decided: the first tick from which a
// condition stayed violated, else where the largest value that it speaks of was reached.
struct ExpectationOutcome {
  std::string text;     // as written, with its times
  std::string place;    // FILE:LINE:COLUMN
  bool passed = false;  // in this run; `in` says of how many runs that is asked
  double part = 1.0;    // fraction of seeds in which it must hold
  // What the condition speaks of, at its place or over its time: "max abs base.rpy.pitch" 0.061.
  std::vector<std::pair<std::string, double>> values;
  std::string value;  // the same for people, with units
  std::optional<double> at;
  std::optional<std::int64_t> tick;
  std::string state;  // paths of the active atomic states there
  std::string why;    // one sentence; empty if it passed
};

// What of the behavior a run reached, by index.
struct RunCoverage {
  std::vector<bool> states;                 // of Chart::states: entered
  std::vector<bool> transitions;            // of Chart::transitions: taken
  std::vector<bool> when_true, when_false;  // of Chart::transitions: what its guard has given
};
RunCoverage coverage_of(const behaviors::Machine& machine, const behaviors::Chart& chart,
                        std::vector<bool> transitions_taken);

// A failure that is none of an expectation's.
struct ScenarioFailure {
  enum class Kind : std::uint8_t {
    end,     // a fall, a fault, or stopped by hand
    script,  // an entry that never came or could not be done
    golden,
  };
  Kind kind = Kind::end;
  std::string place;         // FILE:LINE:COLUMN
  std::string text;          // one line, with time and state
  std::optional<double> at;  // s; nullopt: of no one time
};
const char* failure_kind_name(ScenarioFailure::Kind kind);
// [{"kind", "place", "text", "at_s"}]
nlohmann::ordered_json failures_json(const std::vector<ScenarioFailure>& failures);

struct ScenarioOutcome {
  std::uint64_t seed = 0;
  bool passed = false;                           // every expectation, and nothing else failed
  std::vector<ScenarioFailure> failures;         // beside the expectations
  std::vector<ExpectationOutcome> expectations;  // one for each of the description
  RunCoverage coverage;
  std::string end;     // run_end_name
  std::string golden;  // the trace that was compared with, or is missing; empty: none was
  std::string log;     // path; empty: none
};

// {"scenario", "path", "seed", "passed", "failures": [{"kind", "place", "text", "at_s"}],
//  "expectations": [{"text", "place", "passed", "part", "value", "values": {NAME: number}, "at_s",
//                    "tick", "state", "why"}],
//  "coverage": {"states": [PATH, ...],
//               "transitions": [{"index", "source", "file", "line", "taken"}],
//               "guards": [{"index", "file", "line", "true", "false"}]},
//  "end", "figures": `figures`, "golden", "log"}
// SI; what does not apply is null. states: those that were entered; guards: of the transitions with
// a condition, by their index.
nlohmann::ordered_json outcome_json(const ScenarioDescription& scenario,
                                    const ScenarioOutcome& outcome,
                                    const nlohmann::ordered_json& figures);

// FILE:LINE:COLUMN of something that a scenario says.
std::string place_in_file(const ScenarioDescription& scenario, core::Mark mark);

// A verdict and what decided it, a line an expectation; then coverage in one line.
std::string outcome_text(const ScenarioDescription& scenario, const ScenarioOutcome& outcome);

}  // namespace footfall::lab
