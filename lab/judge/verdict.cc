// What is said of each expectation when the run has ended; see judge.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/units/units.h"
#include "lab/judge/judge.h"

namespace footfall::lab {
namespace {

constexpr RunEnd kEnds[] = {RunEnd::time, RunEnd::finished, RunEnd::fall, RunEnd::fault};

// As written, and the time in which it is judged.
std::string described(const Expectation& e) {
  std::string text = e.text;
  if (e.kind == Expectation::Kind::never) text = "never: " + text;
  if (e.to) {
    text += fmt::format(", between {:g} s and {:g} s", e.from, *e.to);
  } else if (e.from > 0.0) {
    text += fmt::format(", after {:g} s", e.from);
  }
  if (e.within) text += fmt::format(", within {:g} s", *e.within);
  return text;
}

}  // namespace

bool is_good_end(RunEnd end) { return end == RunEnd::time || end == RunEnd::finished; }
RunEnd scenario_end(int word) { return kEnds[at(word)]; }

std::string ending_text(const RunResult& result, double time) {
  if (result.end == RunEnd::fall && result.cause) return "the robot fell: " + result.cause->text;
  if (result.cause) return "the run was stopped: " + result.cause->text;
  return fmt::format("the run ended by {} at {:.3f} s", run_end_name(result.end), time);
}

std::vector<ExpectationOutcome> ScenarioJudge::finish(const RunResult& result) {
  std::vector<ExpectationOutcome> outcomes;
  result_ = &result;
  for (Judged& judged : judged_) {
    const Expectation& expectation = *judged.expectation;
    ExpectationOutcome& out = outcomes.emplace_back();
    out.text = described(expectation);
    out.place = place_in_file(scenario_, expectation.mark);
    out.part = expectation.part;
    switch (expectation.kind) {
      case Expectation::Kind::that:
        finish_that(judged, out);
        break;
      case Expectation::Kind::never:
        finish_never(judged, out);
        break;
      case Expectation::Kind::sequence:
        finish_sequence(judged, out);
        break;
      case Expectation::Kind::end:
        finish_end(judged, out);
        break;
    }
  }
  return outcomes;
}

// Whether the run ended before the end of a time that was asked for: what it would have done in
// the rest is not known.
bool ScenarioJudge::is_cut(const Judged& judged) const {
  const std::optional<double>& to = judged.expectation->to;
  return to && loop_.time() + 0.5 * loop_.period() < *to;
}

// A condition over what is never there says nothing. Empty: each operand had a value once.
std::string ScenarioJudge::never_had_value(const Judged& judged) const {
  for (std::size_t k = 0; k < judged.operands.size(); ++k) {
    if (judged.had_value[k]) continue;
    return fmt::format("'{}' never had a value in this time: it was not judged",
                       scenario_.signals.info(judged.operands[k]).name);
  }
  return {};
}

std::string ScenarioJudge::not_reached(const Judged& judged) const {
  if (judged.first > judged.last) return "no tick is in this time";
  const std::string why = result_->cause ? ending_text(*result_, loop_.time())
                                         : fmt::format("the run ended at {:.3f} s", loop_.time());
  return why + (judged.judged ? ", before this time was over" : ", before it could be judged");
}

// A fall or a fault decides what its tick did: the states that it leads to are consequences.
void ScenarioJudge::finish_never(const Judged& judged, ExpectationOutcome& out) const {
  if (!judged.judged || (!judged.decided && is_cut(judged))) {
    out.why = not_reached(judged);
    return;
  }
  if (!judged.decided) out.why = never_had_value(judged);
  out.passed = !judged.decided && out.why.empty();
  if (!judged.decided) return;
  const bool at_the_end = result_->cause && judged.place.tick == last_.tick;
  out.why =
      at_the_end ? "it became so when " + ending_text(*result_, loop_.time()) : "it became so";
  tell_place(judged.place, out);
  tell_values(judged, out);
}

void ScenarioJudge::finish_that(Judged& judged, ExpectationOutcome& out) {
  if (judged.at_end) {
    judged.judged = true;
    judged.holds = evaluate(judged);
    mark(judged);
    judged.place = last_;
  }
  const bool every_tick =
      !judged.at_end && judged.statistics.empty() && !judged.expectation->within;
  const bool holds = every_tick ? !judged.decided : judged.holds;
  if (!judged.judged || (holds && !judged.expectation->within && is_cut(judged))) {
    out.why = not_reached(judged);
    return;
  }
  out.passed = holds;
  if (out.passed && every_tick) return;  // no one tick speaks for all
  if (!judged.statistics.empty() && (out.passed || judged.place.tick < 0)) {
    judged.place = judged.statistics.front().decided_at;
  }
  if (!judged.statistics.empty() || judged.place.tick < 0) {
    // What the whole time came to, not what it was at the place.
    for (const Running& running : judged.statistics) {
      signals_[running.of->value] = running.statistic.value();
    }
    for (std::size_t k = 0; k < judged.operands.size(); ++k) {
      judged.values[k] = signals_[judged.operands[k]];
    }
  }
  tell_values(judged, out);
  if (judged.place.tick < 0) judged.place = last_;
  tell_place(judged.place, out);
  if (out.passed) return;
  for (std::size_t k = 0; k < judged.operands.size(); ++k) {
    if (std::isfinite(judged.values[k])) continue;
    out.why = fmt::format("'{}' has no value there: it counts as not so",
                          scenario_.signals.info(judged.operands[k]).name);
    return;
  }
  out.why = judged.at_end                ? "not so at the end of the run"
            : judged.expectation->within ? "it never became so"
            : judged.statistics.empty()  ? "not so"
                                         : "not so over this time";
}

void ScenarioJudge::finish_sequence(const Judged& judged, ExpectationOutcome& out) {
  out.passed = judged.holds;
  const auto& states = judged.expectation->states;
  const auto path = [&](std::size_t k) { return scenario_.behavior->states[at(states[k])].path; };
  if (judged.fastest >= 0) {
    out.values.emplace_back("duration", time_of(judged.fastest));
    out.value = fmt::format("{:.4g} s", time_of(judged.fastest));
  }
  tell_place(judged.place, out);
  if (out.passed) return;
  if (judged.fastest >= 0) {
    out.why = fmt::format("the fastest took {:.4g} s", time_of(judged.fastest));
    return;
  }
  const auto passed = std::ranges::count_if(judged.begun, [](std::int64_t t) { return t >= 0; });
  const auto next = static_cast<std::size_t>(passed);
  out.why = next == 0 ? fmt::format("'{}' was never entered", path(0))
                      : fmt::format("'{}' was not entered after '{}'", path(next), path(next - 1));
}

void ScenarioJudge::finish_end(const Judged& judged, ExpectationOutcome& out) const {
  const std::vector<int>& ends = judged.expectation->ends;
  const RunEnd end = result_->end;
  out.passed = std::ranges::any_of(ends, [&](int word) { return scenario_end(word) == end; });
  out.value = run_end_name(end);
  if (!out.passed) {
    out.why = ending_text(*result_, loop_.time());
    out.at = loop_.time();
  }
}

void ScenarioJudge::tell_place(const Place& place, ExpectationOutcome& out) const {
  if (place.tick < 0) return;
  out.tick = place.tick;
  out.at = time_of(place.tick);
  out.state = names_of(place);
}

std::string ScenarioJudge::names_of(const Place& place) const {
  std::string names;
  for (int k = 0; k < place.count; ++k) {
    if (k > 0) names += ", ";
    names += scenario_.behavior->states[at(place.states[at(k)])].path;
  }
  return names;
}

void ScenarioJudge::tell_values(const Judged& judged, ExpectationOutcome& out) const {
  for (std::size_t k = 0; k < judged.operands.size(); ++k) {
    const core::SignalInfo& info = scenario_.signals.info(judged.operands[k]);
    const std::string unit = core::unit_text(info.dimension);
    out.values.emplace_back(info.name, judged.values[k]);
    if (!out.value.empty()) out.value += ", ";
    out.value +=
        fmt::format("{} = {:.4g}{}{}", info.name, judged.values[k], unit.empty() ? "" : " ", unit);
  }
}

}  // namespace footfall::lab
