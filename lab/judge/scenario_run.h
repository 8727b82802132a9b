// One seed of one scenario, in lock-step: the script acts, the expectations are judged, coverage
// and the golden trace are gathered, all outside of the tick. Which backend it is, the caller
// knows.
#pragma once

#include "lab/judge/result.h"
#include "lab/judge/script_events.h"
#include "lab/run/run.h"
#include "lab/scenario/golden_trace.h"

namespace footfall::lab {

struct ScenarioRun {
  ScenarioOutcome outcome;
  RunResult run;
  GoldenTrace trace;  // of the signals that `golden` names; empty without it
};

// Runs `loop`, which was built for scenario.behavior and not started, for the scenario's time.
// `spec`: log, status and the like; its time, events and observer are the scenario's. The golden
// trace is compared if this is the scenario's first seed. Throws what lab::run() throws.
ScenarioRun run_scenario(const ScenarioDescription& scenario, std::uint64_t seed,
                         engine::ControlLoop& loop, const ScenarioHooks& hooks, RunSpec spec);

}  // namespace footfall::lab
