// Reads verdicts from children's output and judges expectations over seeds; see run.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/text/json_text.h"
#include "core/text/printable.h"
#include "lab/process/result_line.h"
#include "lab/suite/run.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kTailLines = 12;

std::string last_lines(const std::string& text, std::size_t lines) {
  std::size_t begin = text.size();
  if (begin > 0 && text[begin - 1] == '\n') --begin;
  for (std::size_t n = 0; n < lines && begin > 0; ++n) {
    const std::size_t line = text.rfind('\n', begin - 1);
    if (line == std::string::npos) return text;
    begin = line;
  }
  return text.substr(begin + (begin < text.size() && text[begin] == '\n' ? 1 : 0));
}

std::optional<double> number_of(const nlohmann::json& map, const char* key) {
  const auto found = map.find(key);
  if (found == map.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// nullopt if malformed.
std::optional<Observation> read_observation(const nlohmann::json& item) {
  if (!item.is_object() || !item.contains("passed") || !item["passed"].is_boolean()) return {};
  Observation out;
  out.passed = item["passed"].get<bool>();
  out.value = text_at(item, "value");
  out.at = number_of(item, "at_s");
  out.tick = static_cast<std::int64_t>(number_of(item, "tick").value_or(-1.0));
  out.state = text_at(item, "state");
  out.why = text_at(item, "why");
  return out;
}

// Why the object is not the result of this run; empty if it is.
std::string misfit(const nlohmann::json& object, const SuiteScenario& scenario,
                   const SuiteRun& run) {
  if (object.is_null()) return "its output ends without a result";
  if (!object.contains("passed") || !object["passed"].is_boolean())
    return "its result has no verdict";
  const auto seed = object.find("seed");
  if (seed != object.end() && *seed != run.seed) return "its result is of another seed";
  const auto list = object.find("expectations");
  if (list == object.end() || !list->is_array() || list->size() != scenario.expectations.size()) {
    return fmt::format("its result does not contain the {} expectations",
                       scenario.expectations.size());
  }
  return "";
}

// nullopt if malformed.
std::optional<ScenarioFailure> read_failure(const nlohmann::json& item) {
  using Kind = ScenarioFailure::Kind;
  if (!item.is_object()) return {};
  ScenarioFailure out;
  const std::string kind = text_at(item, "kind");
  const auto kinds = {Kind::end, Kind::script, Kind::golden};
  const auto found = std::ranges::find(kinds, kind, failure_kind_name);
  if (found == kinds.end()) return {};
  out.kind = *found;
  out.place = text_at(item, "place");
  out.text = text_at(item, "text");
  out.at = number_of(item, "at_s");
  return out;
}

void malformed(SuiteRun& run, const char* what) {
  run.observations.clear();
  run.failures.clear();
  run.verdict = Verdict::bad_output;
  run.why = what;
}

void read_object(const nlohmann::json& object, int exit_code, SuiteRun& run) {
  run.end = text_at(object, "end");
  bool all = true;
  for (const nlohmann::json& item : object["expectations"]) {
    const auto observation = read_observation(item);
    if (!observation) return malformed(run, "an expectation in its result is malformed");
    all = all && observation->passed;
    run.observations.push_back(*observation);
  }
  for (const nlohmann::json& item : object.value("failures", nlohmann::json::array())) {
    const auto failure = read_failure(item);
    if (!failure) return malformed(run, "a failure in its result is malformed");
    run.failures.push_back(*failure);
  }
  const bool passed = object["passed"].get<bool>();
  run.verdict = passed ? Verdict::passed : Verdict::failed;
  if (passed && exit_code != 0) {
    run.verdict = Verdict::bad_output;
    run.why = fmt::format("its result is `passed`, its exit code {}", exit_code);
  } else if (passed != (all && run.failures.empty())) {
    malformed(run, "the verdict of its result is not that of its expectations and failures");
  }
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::passed:
      return "passed";
    case Verdict::failed:
      return "failed";
    case Verdict::crashed:
      return "crashed";
    case Verdict::timed_out:
      return "timed out";
    case Verdict::bad_input:
      return "bad input";
    case Verdict::bad_output:
      return "bad output";
    case Verdict::machine:
      return "machine failed";
    case Verdict::stopped:
      return "stopped";
  }
  return "";
}

void read_result(const ProcessResult& result, const SuiteScenario& scenario, SuiteRun& run,
                 Coverage& coverage) {
  run.wall_time = result.wall_time;
  run.cpu_time = result.cpu_time;
  run.error_tail = core::printable_lines(last_lines(result.err, kTailLines));
  run.why = describe(result);
  switch (result.end) {
    case ProcessEnd::signalled:
      run.verdict = Verdict::crashed;
      return;
    case ProcessEnd::timed_out:
      run.verdict = Verdict::timed_out;
      return;
    case ProcessEnd::cancelled:
      run.verdict = Verdict::stopped;
      return;
    case ProcessEnd::not_started:
      run.verdict = Verdict::machine;
      return;
    case ProcessEnd::exited:
      break;
  }
  if (result.exit_code != 0 && result.exit_code != 1) {
    run.verdict = result.exit_code == 2   ? Verdict::bad_input
                  : result.exit_code == 3 ? Verdict::machine
                                          : Verdict::bad_output;
    return;
  }
  const nlohmann::json object = result_line(result.out);
  run.why = misfit(object, scenario, run);
  if (!run.why.empty()) {
    run.verdict = Verdict::bad_output;
    return;
  }
  read_object(object, result.exit_code, run);
  const auto covered = object.find("coverage");
  if (covered != object.end()) coverage.add(scenario.map, *covered);
}

ScenarioResult judge(const Suite& suite, std::size_t scenario) {
  const SuiteScenario& what = suite.scenarios[scenario];
  ScenarioResult result;
  result.judgements.resize(what.expectations.size());
  result.complete = true;
  for (std::size_t r = 0; r < suite.runs.size(); ++r) {
    const SuiteRun& run = suite.runs[r];
    if (run.scenario != scenario) continue;
    result.wall_time += run.wall_time;
    if (run.verdict == Verdict::stopped) {
      result.complete = false;
      continue;
    }
    const bool by_expectation = run.verdict == Verdict::failed && run.failures.empty();
    if (run.verdict != Verdict::passed && !by_expectation) result.broken.push_back(r);
    for (std::size_t e = 0; e < result.judgements.size(); ++e) {
      Judgement& judgement = result.judgements[e];
      ++judgement.of;
      const bool held = e < run.observations.size() && run.observations[e].passed;
      judgement.held += held ? 1U : 0U;
      if (!held) judgement.broke.push_back(r);
    }
  }
  result.passed = what.errors.empty() && result.complete && result.broken.empty();
  for (std::size_t e = 0; e < result.judgements.size(); ++e) {
    Judgement& judgement = result.judgements[e];
    // Tolerates rounding: 0.95 * 20 is not exactly 19.
    const double needed = what.expectations[e].part * static_cast<double>(judgement.of) - 1e-6;
    judgement.passed = static_cast<double>(judgement.held) >= needed;
    result.passed = result.passed && judgement.passed;
  }
  return result;
}

}  // namespace footfall::lab
