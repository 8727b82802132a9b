// A scenario's run put together; see scenario_run.h.
#include "lab/judge/scenario_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "lab/judge/judge.h"

namespace footfall::lab {
namespace {

class Stage final : public RunObserver {
 public:
  Stage(const ScenarioDescription& scenario, engine::ControlLoop& loop, const ScenarioHooks& hooks,
        std::uint64_t seed)
      : loop_(loop),
        cues(scenario, hooks, loop, seed),
        judge(scenario, loop),
        taken(scenario.behavior->transitions.size(), false) {
    if (scenario.golden) recorder.emplace(*scenario.golden, loop);
  }
  void before_tick(const StepClock& steps, RunLog& log) override { cues.fire(steps, log); }
  void after_tick() override {
    for (const int t : loop_.machine().transitions_taken()) {
      taken[static_cast<std::size_t>(t)] = true;
    }
    cues.observe();
    judge.observe();
    if (recorder) recorder->observe();
  }

 private:
  engine::ControlLoop& loop_;

 public:
  ScenarioCues cues;
  ScenarioJudge judge;
  std::vector<bool> taken;
  std::optional<GoldenRecorder> recorder;
};

// What is wrong with the trace; empty: nothing.
std::string judge_golden(const ScenarioDescription& scenario, const GoldenTrace& got) {
  const GoldenSpec& spec = *scenario.golden;
  if (!std::filesystem::exists(spec.path)) {
    return "no golden trace yet at " + spec.path + ": `footfall test --bless` writes it";
  }
  try {
    const std::string difference =
        compare_golden(spec, scenario.behavior->signals, read_golden(spec.path), got);
    return difference.empty() ? "" : "leaves the golden trace: " + difference;
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

bool names_an_end(const ScenarioDescription& scenario) {
  return std::ranges::any_of(scenario.expectations,
                             [](const Expectation& e) { return e.kind == Expectation::Kind::end; });
}

}  // namespace

ScenarioRun run_scenario(const ScenarioDescription& scenario, std::uint64_t seed,
                         engine::ControlLoop& loop, const ScenarioHooks& hooks, RunSpec spec) {
  Stage stage(scenario, loop, hooks, seed);
  spec.max_time = scenario.duration;
  spec.max_steps = 0;
  spec.observer = &stage;
  ScenarioRun out;
  out.run = run(loop, spec);
  ScenarioOutcome& outcome = out.outcome;
  outcome.seed = seed;
  outcome.end = run_end_name(out.run.end);
  outcome.expectations = stage.judge.finish(out.run.end);
  outcome.coverage = coverage_of(loop.machine(), loop.behavior(), stage.taken);
  outcome.why = stage.cues.problem();
  if (outcome.why.empty() && out.run.end == RunEnd::stopped) outcome.why = "it was stopped";
  if (outcome.why.empty() && !names_an_end(scenario) && !is_good_end(out.run.end)) {
    outcome.why = fmt::format("the run ended by {} at {:.3f} s, in {}", outcome.end, loop.time(),
                              stage.judge.last_state());
  }
  if (outcome.why.empty()) outcome.why = stage.cues.missed();
  if (stage.recorder) {
    out.trace = stage.recorder->trace();
    if (seed == scenario.seeds.front()) {
      outcome.golden = scenario.golden->path;
      if (outcome.why.empty()) outcome.why = judge_golden(scenario, out.trace);
    }
  }
  outcome.passed =
      outcome.why.empty() && std::ranges::all_of(outcome.expectations, &ExpectationOutcome::passed);
  return out;
}

}  // namespace footfall::lab
