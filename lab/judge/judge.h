// Judges the expectations of a scenario while it runs: looked at after every tick, outside of it,
// without touching the run.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "behaviors/expression/statistics.h"
#include "engine/tick/control_loop.h"
#include "lab/judge/result.h"
#include "lab/run/run.h"
#include "lab/scenario/description.h"

namespace footfall::lab {

class ScenarioJudge {
 public:
  // Both must outlive it.
  ScenarioJudge(const ScenarioDescription& scenario, const engine::ControlLoop& loop);

  // After each tick's compute().
  void observe();
  // When the run has ended: one outcome for each expectation, in their order.
  std::vector<ExpectationOutcome> finish(const RunResult& result);

 private:
  // Where something was seen.
  struct Place {
    std::int64_t tick = -1;  // -1: nowhere
    std::array<int, 4> states{};
    int count = 0;
  };
  // A statistic over the time of one expectation.
  struct Running {
    const SignalStatistic* of = nullptr;
    behaviors::RunningStatistic statistic;
    Place decided_at;
  };
  struct Judged {
    const Expectation* expectation = nullptr;
    std::int64_t first = 0, last = 0;  // ticks of its time
    bool at_end = false;               // a lone condition: judged once, when the run ends
    std::vector<int> operands;         // signals it speaks of
    std::vector<Running> statistics;
    std::vector<bool> had_value;  // of each operand, in some tick
    bool judged = false;          // at least once
    bool holds = false;           // at the latest tick
    bool decided = false;         // nothing can change it
    Place place;
    std::vector<double> values;  // of the operands, at the place
    // Of a sequence: by length of what was passed, when that began (latest) and the entries seen.
    std::vector<std::int64_t> begun;
    std::vector<std::uint32_t> entries;
    std::int64_t fastest = -1;  // ticks
  };

  Place here() const;
  void take_signals();
  bool evaluate(const Judged& judged);
  void note_values(Judged& judged) const;
  void mark(Judged& judged);
  void observe_that(Judged& judged);
  void observe_sequence(Judged& judged);
  void update(Running& running);
  std::string not_reached(const Judged& judged) const;
  bool is_cut(const Judged& judged) const;
  std::string never_had_value(const Judged& judged) const;
  void finish_never(const Judged& judged, ExpectationOutcome& out) const;
  void finish_that(Judged& judged, ExpectationOutcome& out);
  void finish_sequence(const Judged& judged, ExpectationOutcome& out);
  void finish_end(const Judged& judged, ExpectationOutcome& out) const;
  std::string names_of(const Place& place) const;
  void tell_place(const Place& place, ExpectationOutcome& out) const;
  void tell_values(const Judged& judged, ExpectationOutcome& out) const;
  double time_of(std::int64_t tick) const { return static_cast<double>(tick) * loop_.period(); }

  const ScenarioDescription& scenario_;
  const engine::ControlLoop& loop_;
  core::SignalTable signals_;  // the run's, and the statistics behind them
  std::vector<Judged> judged_;
  std::int64_t tick_ = 0;
  Place last_;
  const RunResult* result_ = nullptr;  // while finish() runs
};

// Whether a run that ends so has gone as it should where nothing is said: to the end of its time,
// or to a final state.
bool is_good_end(RunEnd end);
// How the run ended; of a fall or a fault: its criterion and state.
std::string ending_text(const RunResult& result, double time);
// The ends that an `end:` expectation may name, in the order of kScenarioEnds.
RunEnd scenario_end(int word);

}  // namespace footfall::lab
