// Expectations, tick by tick; see judge.h.
#include "lab/judge/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "behaviors/expression/expression.h"
#include "core/index.h"

namespace footfall::lab {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRoundOff = 1e-6;  // of a time in ticks

// The signals that an expression reads, each once.
std::vector<int> operands_of(const behaviors::ExpressionPool& pool, int expression) {
  std::vector<int> operands;
  const behaviors::Expression& e = pool[expression];
  for (int k = e.first; k < e.first + e.count; ++k) {
    const behaviors::Instruction& code = pool.code[at(k)];
    if (code.op != behaviors::Op::signal) continue;
    if (std::ranges::find(operands, code.index) == operands.end()) operands.push_back(code.index);
  }
  return operands;
}

}  // namespace

ScenarioJudge::ScenarioJudge(const ScenarioDescription& scenario, const engine::ControlLoop& loop)
    : scenario_(scenario), loop_(loop), signals_(scenario.signals) {
  const double rate = 1.0 / loop.period();
  const auto last_tick = std::numeric_limits<std::int64_t>::max();
  for (const Expectation& expectation : scenario.expectations) {
    Judged judged;
    judged.expectation = &expectation;
    judged.first = std::llround(std::ceil(expectation.from * rate - kRoundOff));
    std::optional<double> to = expectation.to;
    const bool that = expectation.kind == Expectation::Kind::that;
    if (that && expectation.within) to = expectation.from + *expectation.within;
    judged.last = to ? std::llround(std::floor(*to * rate + kRoundOff)) : last_tick;
    if (expectation.expression >= 0) {
      judged.operands = operands_of(scenario.expressions, expectation.expression);
      judged.values.assign(judged.operands.size(), kNan);
      judged.had_value.assign(judged.operands.size(), false);
    }
    for (const SignalStatistic& of : scenario.statistics) {
      if (std::ranges::find(judged.operands, of.value) == judged.operands.end()) continue;
      judged.statistics.push_back({&of, behaviors::RunningStatistic(*of.statistic), {}});
    }
    judged.at_end = that && judged.statistics.empty() && !expectation.timed && !expectation.within;
    judged.begun.assign(expectation.states.size(), -1);
    judged.entries.assign(expectation.states.size(), 0);
    judged_.push_back(std::move(judged));
  }
}

ScenarioJudge::Place ScenarioJudge::here() const {
  Place place;
  place.tick = tick_;
  for (const int s : loop_.machine().active_atomic()) {
    if (at(place.count) < place.states.size()) place.states[at(place.count++)] = s;
  }
  return place;
}

void ScenarioJudge::take_signals() {
  std::copy_n(loop_.signals().values(), loop_.signals().size(), signals_.values());
}

void ScenarioJudge::observe() {
  tick_ = loop_.ticks();
  last_ = here();
  if (judged_.empty()) return;
  take_signals();
  for (Judged& judged : judged_) {
    if (judged.decided || tick_ < judged.first || tick_ > judged.last) continue;
    switch (judged.expectation->kind) {
      case Expectation::Kind::that:
        if (!judged.at_end) observe_that(judged);
        break;
      case Expectation::Kind::never:
        judged.judged = true;
        note_values(judged);
        if (evaluate(judged)) {
          mark(judged);
          judged.decided = true;
        }
        break;
      case Expectation::Kind::sequence:
        observe_sequence(judged);
        break;
      case Expectation::Kind::end:
        break;
    }
  }
}

bool ScenarioJudge::evaluate(const Judged& judged) {
  behaviors::EvaluationContext context = loop_.machine().context();
  context.signals = signals_.values();
  const double value =
      behaviors::evaluate(scenario_.expressions, judged.expectation->expression, context);
  return std::isfinite(value) && value != 0.0;
}

void ScenarioJudge::note_values(Judged& judged) const {
  for (std::size_t k = 0; k < judged.operands.size(); ++k) {
    if (std::isfinite(signals_[judged.operands[k]])) judged.had_value[k] = true;
  }
}

// This tick is where it was decided, as far as is known.
void ScenarioJudge::mark(Judged& judged) {
  judged.place = here();
  for (std::size_t k = 0; k < judged.operands.size(); ++k) {
    judged.values[k] = signals_[judged.operands[k]];
  }
}

// With a statistic: its value so far; at the end of its time it must hold. `within`: it must
// hold once. Else it must hold in every tick.
void ScenarioJudge::observe_that(Judged& judged) {
  for (Running& running : judged.statistics) update(running);
  const bool before = judged.holds || !judged.judged;
  judged.holds = evaluate(judged);
  const bool first = !judged.judged;
  judged.judged = true;
  if (judged.expectation->within) {
    judged.decided = judged.holds;
    return;
  }
  if (judged.holds || !before) return;
  if (first && !judged.statistics.empty())
    return;  // it never held: the sample that decided is shown
  mark(judged);
  judged.decided = judged.statistics.empty();
}

void ScenarioJudge::update(Running& running) {
  const double value = signals_[running.of->signal];
  if (running.statistic.add(running.of->magnitude ? std::abs(value) : value)) {
    running.decided_at = here();
  }
  signals_[running.of->value] = running.statistic.value();
}

// The latest beginning of each part of the sequence that was passed in order; the latest is the
// best, since the time to the end is what counts.
void ScenarioJudge::observe_sequence(Judged& judged) {
  judged.judged = true;
  const std::vector<int>& states = judged.expectation->states;
  std::int64_t before = -1;  // begun[k - 1] as it was at the tick's begin
  for (std::size_t k = 0; k < states.size(); ++k) {
    const std::int64_t mine = judged.begun[k];
    const std::uint32_t entries = loop_.machine().entries(states[k]);
    const bool entered = entries != judged.entries[k];
    judged.entries[k] = entries;
    if (entered && tick_ >= judged.first) {
      const bool repeated = k > 0 && states[k] == states[k - 1];
      const std::int64_t begin = k == 0 ? tick_ : repeated ? before : judged.begun[k - 1];
      if (begin >= 0) {
        judged.begun[k] = begin;
        judged.place = here();
        if (k + 1 == states.size()) {
          const std::int64_t took = tick_ - begin;
          if (judged.fastest < 0 || took < judged.fastest) judged.fastest = took;
        }
      }
    }
    before = mine;
  }
  if (judged.fastest < 0) return;
  const auto& within = judged.expectation->within;
  judged.holds = !within || time_of(judged.fastest) <= *within + 0.5 * loop_.period();
  judged.decided = judged.holds;
}

}  // namespace footfall::lab
