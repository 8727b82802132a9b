// A scenario's run put together; see scenario_run.h.
#include "lab/judge/scenario_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
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

// What is wrong with the trace.
GoldenMismatch judge_golden(const ScenarioDescription& scenario, const GoldenTrace& got) {
  const GoldenSpec& spec = *scenario.golden;
  if (!std::filesystem::exists(spec.path)) {
    return {"no golden trace yet at " + spec.path + ": `footfall test --bless` writes it", {}};
  }
  try {
    GoldenMismatch found =
        compare_golden(spec, scenario.behavior->signals, read_golden(spec.path), got);
    if (!found.text.empty()) found.text = "leaves the golden trace: " + found.text;
    return found;
  } catch (const std::runtime_error& error) {
    return {error.what(), {}};
  }
}

bool names_an_end(const ScenarioDescription& scenario) {
  return std::ranges::any_of(scenario.expectations,
                             [](const Expectation& e) { return e.kind == Expectation::Kind::end; });
}

// Failures beside the expectations. After a bad end, entries that never came and the rest of the
// trace are its consequences.
std::vector<ScenarioFailure> failures_of(const ScenarioDescription& scenario, const Stage& stage,
                                         const RunResult& result, double time, bool traced) {
  using Kind = ScenarioFailure::Kind;
  std::vector<ScenarioFailure> list = stage.cues.problems();
  const bool stopped = result.end == RunEnd::stopped;
  if (stopped || (!names_an_end(scenario) && !is_good_end(result.end))) {
    list.push_back({Kind::end, scenario.path + ":1:1",
                    stopped ? "it was stopped" : ending_text(result, time), time});
    return list;
  }
  std::ranges::move(stage.cues.missed(), std::back_inserter(list));
  if (traced) {
    const GoldenMismatch found = judge_golden(scenario, stage.recorder->trace());
    if (!found.text.empty()) {
      list.push_back(
          {Kind::golden, place_in_file(scenario, scenario.golden->mark), found.text, found.at});
    }
  }
  return list;
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
  outcome.expectations = stage.judge.finish(out.run);
  outcome.coverage = coverage_of(loop.machine(), loop.behavior(), stage.taken);
  const bool traced = stage.recorder && seed == scenario.seeds.front();
  outcome.failures = failures_of(scenario, stage, out.run, loop.time(), traced);
  if (stage.recorder) out.trace = stage.recorder->trace();
  if (traced) outcome.golden = scenario.golden->path;
  outcome.passed = outcome.failures.empty() &&
                   std::ranges::all_of(outcome.expectations, &ExpectationOutcome::passed);
  return out;
}

}  // namespace footfall::lab
