// The result of a scenario as JSON and text; see result.h.
#include "lab/judge/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/index.h"

namespace footfall::lab {
namespace {

using Json = nlohmann::ordered_json;

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json expectation_json(const ExpectationOutcome& e) {
  Json values = Json::object();
  for (const auto& [name, value] : e.values) {
    values[name] = std::isfinite(value) ? Json(value) : Json();
  }
  return {{"text", e.text},
          {"place", e.place},
          {"passed", e.passed},
          {"part", e.part},
          {"value", text_or_null(e.value)},
          {"values", std::move(values)},
          {"at_s", e.at ? Json(*e.at) : Json()},
          {"tick", e.tick ? Json(*e.tick) : Json()},
          {"state", text_or_null(e.state)},
          {"why", text_or_null(e.why)}};
}

std::string file_of(const ScenarioDescription& scenario, core::Mark mark) {
  const auto index = static_cast<std::size_t>(mark.file);
  return mark.file >= 0 && index < scenario.behavior_files.size() ? scenario.behavior_files[index]
                                                                  : std::string();
}

Json coverage_json(const ScenarioDescription& scenario, const RunCoverage& coverage) {
  const behaviors::Chart& chart = *scenario.behavior;
  Json states = Json::array(), transitions = Json::array(), guards = Json::array();
  for (std::size_t s = 0; s < coverage.states.size(); ++s) {
    if (coverage.states[s]) states.push_back(chart.states[s].path);
  }
  for (std::size_t t = 0; t < coverage.transitions.size(); ++t) {
    const behaviors::TransitionInfo& info = chart.transitions[t];
    const std::string file = file_of(scenario, info.mark);
    transitions.push_back({{"index", t},
                           {"source", chart.states[at(info.source)].path},
                           {"file", file},
                           {"line", info.mark.line},
                           {"taken", static_cast<bool>(coverage.transitions[t])}});
    if (info.guard < 0) continue;
    guards.push_back({{"index", t},
                      {"file", file},
                      {"line", info.mark.line},
                      {"true", static_cast<bool>(coverage.when_true[t])},
                      {"false", static_cast<bool>(coverage.when_false[t])}});
  }
  return {{"states", std::move(states)},
          {"transitions", std::move(transitions)},
          {"guards", std::move(guards)}};
}

}  // namespace

const char* failure_kind_name(ScenarioFailure::Kind kind) {
  switch (kind) {
    case ScenarioFailure::Kind::end:
      return "end";
    case ScenarioFailure::Kind::script:
      return "script";
    case ScenarioFailure::Kind::golden:
      return "golden";
  }
  return "";
}

Json failures_json(const std::vector<ScenarioFailure>& failures) {
  Json list = Json::array();
  for (const ScenarioFailure& failure : failures) {
    list.push_back({{"kind", failure_kind_name(failure.kind)},
                    {"place", failure.place},
                    {"text", failure.text},
                    {"at_s", failure.at ? Json(*failure.at) : Json()}});
  }
  return list;
}

std::string place_in_file(const ScenarioDescription& scenario, core::Mark mark) {
  const auto file = static_cast<std::size_t>(mark.file);
  const bool known = mark.file >= 0 && file < scenario.files.size();
  return fmt::format("{}:{}:{}", known ? scenario.files[file] : scenario.path, mark.line,
                     mark.column);
}

RunCoverage coverage_of(const behaviors::Machine& machine, const behaviors::Chart& chart,
                        std::vector<bool> transitions_taken) {
  RunCoverage coverage;
  coverage.transitions = std::move(transitions_taken);
  for (std::size_t s = 0; s < chart.states.size(); ++s) {
    coverage.states.push_back(machine.entries(static_cast<int>(s)) > 0);
  }
  for (std::size_t t = 0; t < chart.transitions.size(); ++t) {
    const std::uint8_t outcomes = machine.guard_outcomes(static_cast<int>(t));
    coverage.when_false.push_back((outcomes & 1U) != 0);
    coverage.when_true.push_back((outcomes & 2U) != 0);
  }
  return coverage;
}

Json outcome_json(const ScenarioDescription& scenario, const ScenarioOutcome& outcome,
                  const Json& figures) {
  Json expectations = Json::array();
  for (const ExpectationOutcome& e : outcome.expectations) {
    expectations.push_back(expectation_json(e));
  }
  return {{"scenario", scenario.name},
          {"path", scenario.path},
          {"seed", outcome.seed},
          {"passed", outcome.passed},
          {"failures", failures_json(outcome.failures)},
          {"expectations", std::move(expectations)},
          {"coverage", coverage_json(scenario, outcome.coverage)},
          {"end", outcome.end},
          {"figures", figures},
          {"golden", text_or_null(outcome.golden)},
          {"log", text_or_null(outcome.log)}};
}

std::string outcome_text(const ScenarioDescription& scenario, const ScenarioOutcome& outcome) {
  std::string text;
  for (const ExpectationOutcome& e : outcome.expectations) {
    text += fmt::format("  {}  {}{}\n", e.passed ? "ok    " : "FAILED", e.text,
                        e.value.empty() ? "" : "   (" + e.value + ")");
    if (e.passed) continue;
    text += fmt::format("          {}: {}\n", e.place, e.why);
    if (e.at)
      text += fmt::format("          at {:.4f} s (tick {}) in {}\n", *e.at, *e.tick, e.state);
  }
  for (const ScenarioFailure& failure : outcome.failures) {
    text += fmt::format("  FAILED  {}: {}\n", failure.place, failure.text);
  }
  const auto count = [](const std::vector<bool>& bits) {
    return std::count(bits.begin(), bits.end(), true);
  };
  text += fmt::format("  {} · seed {}: {}; {} of {} transitions taken\n", scenario.name,
                      outcome.seed, outcome.passed ? "passed" : "FAILED",
                      count(outcome.coverage.transitions), outcome.coverage.transitions.size());
  return text;
}

}  // namespace footfall::lab
