// Failures of a suite, and their description; see suite.h.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "lab/process/pool.h"
#include "lab/suite/suite.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kMostSeedsNamed = 20;

std::string indented(const std::string& text) {
  std::string out;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    out += "              " + text.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  return out;
}

std::string seeds_text(const Suite& suite, const std::vector<std::size_t>& runs) {
  std::string text;
  for (std::size_t i = 0; i < std::min(runs.size(), kMostSeedsNamed); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : " ", suite.runs[runs[i]].seed);
  }
  if (runs.size() > kMostSeedsNamed)
    text += fmt::format(" and {} more", runs.size() - kMostSeedsNamed);
  return text;
}

// The observed value, its time and the active state.
std::string observed(const Observation& seen) {
  std::string text = seen.why;
  if (!seen.value.empty()) {
    text += text.empty() ? seen.value : " (" + seen.value + ")";
  }
  if (seen.at && seen.tick >= 0) {
    text += fmt::format("{}at {:.3f} s (tick {})", text.empty() ? "" : ", ", *seen.at, seen.tick);
  }
  if (!seen.state.empty()) text += " in " + seen.state;
  return text.empty() ? "it did not hold" : text;
}

// What was expected and what happened, and how to repeat the run that shows it.
void describe(const Suite& suite, const std::string& expected, const std::string& seeds,
              SuiteFailure& failure) {
  const SuiteRun& run = suite.runs[*failure.run];
  failure.text = fmt::format("    expected  {}  ({})\n", expected, failure.place);
  failure.text += fmt::format("    happened  {}\n", failure.message);
  if (!seeds.empty()) failure.text += fmt::format("    seeds     {}\n", seeds);
  if (failure.error) failure.text += indented(run.error_tail);
  failure.text += fmt::format("    rerun     {}\n", rerun_command(suite, run));
  if (const RunReport* report = report_of(run, failure.moment)) {
    failure.text += fmt::format("    report    {}\n", report->page);
  }
}

SuiteFailure of_file(const SuiteScenario& scenario) {
  SuiteFailure failure;
  failure.type = verdict_name(Verdict::bad_input);
  failure.error = true;
  // The first line is FILE:LINE:COLUMN: error: WHAT
  const std::string first = scenario.errors.substr(0, scenario.errors.find('\n'));
  const std::size_t end = first.find(": error: ");
  failure.place = end == std::string::npos ? scenario.path : first.substr(0, end);
  failure.message = first;
  failure.text = indented(scenario.errors);
  return failure;
}

SuiteFailure of_error(const Suite& suite, std::size_t r) {
  const SuiteRun& run = suite.runs[r];
  SuiteFailure failure;
  failure.type = verdict_name(run.verdict);
  failure.error = true;
  failure.run = r;
  failure.place = suite.scenarios[run.scenario].path;
  failure.message = fmt::format("seed {}: {}: {}", run.seed, failure.type, run.why);
  describe(suite, "a run to its end", "", failure);
  return failure;
}

const char* expected_of(ScenarioFailure::Kind kind) {
  switch (kind) {
    case ScenarioFailure::Kind::end:
      return "an end without a fall or a fault";
    case ScenarioFailure::Kind::script:
      return "this entry of the script";
    case ScenarioFailure::Kind::golden:
      return "the golden trace, within its tolerances";
  }
  return "";
}

// Runs that failed alike are one failure, described by the first of them.
std::vector<SuiteFailure> beside_expectations(const Suite& suite, const ScenarioResult& result) {
  struct Alike {
    const ScenarioFailure* first = nullptr;
    std::vector<std::size_t> runs;
  };
  std::vector<Alike> groups;
  for (const std::size_t r : result.broken) {
    for (const ScenarioFailure& failure : suite.runs[r].failures) {
      const auto same = std::ranges::find_if(groups, [&](const Alike& a) {
        return a.first->kind == failure.kind && a.first->place == failure.place;
      });
      Alike& group = same == groups.end() ? groups.emplace_back(Alike{&failure, {}}) : *same;
      group.runs.push_back(r);
    }
  }
  std::vector<SuiteFailure> failures;
  for (const Alike& group : groups) {
    SuiteFailure& failure = failures.emplace_back();
    failure.type = failure_kind_name(group.first->kind);
    failure.run = group.runs.front();
    failure.moment = group.first->at;
    failure.place = group.first->place;
    failure.message = fmt::format("seed {}: {}", suite.runs[*failure.run].seed, group.first->text);
    describe(suite, expected_of(group.first->kind),
             group.runs.size() > 1 ? "failed in " + seeds_text(suite, group.runs) : "", failure);
  }
  return failures;
}

// Described by its first run with a result.
SuiteFailure of_expectation(const Suite& suite, std::size_t s, std::size_t e) {
  const SuiteExpectation& expected = suite.scenarios[s].expectations[e];
  const Judgement& judgement = suite.results[s].judgements[e];
  SuiteFailure failure;
  failure.type = "expectation";
  failure.expectation = e;
  failure.run = *std::ranges::find_if(
      judgement.broke, [&](std::size_t r) { return !suite.runs[r].observations.empty(); });
  const SuiteRun& run = suite.runs[*failure.run];
  failure.moment = run.observations[e].at;
  failure.place = expected.place;
  failure.message = fmt::format("seed {}: {}", run.seed, observed(run.observations[e]));
  std::string seeds;
  if (judgement.of > 1) {
    seeds = fmt::format("held in {} of {}, not in {}", judgement.held, judgement.of,
                        seeds_text(suite, judgement.broke));
  }
  describe(suite, expected.text, seeds, failure);
  return failure;
}

}  // namespace

std::string rerun_command(const Suite& suite, const SuiteRun& run) {
  return shell_line(
      {"footfall", "run", suite.scenarios[run.scenario].path, "--seed", std::to_string(run.seed)});
}

bool has_result(const Suite& suite, std::size_t scenario) {
  return std::ranges::any_of(suite.runs, [&](const SuiteRun& run) {
    return run.scenario == scenario &&
           (run.verdict == Verdict::passed || run.verdict == Verdict::failed);
  });
}

const RunReport* report_of(const SuiteRun& run, std::optional<double> moment) {
  const auto found = std::ranges::find_if(run.reports, [&](const RunReport& report) {
    if (!moment || !report.moment) return moment == report.moment;
    const double after = *moment - *report.moment;
    return after >= -kReportBefore && after <= kReportAfter;
  });
  return found == run.reports.end() ? nullptr : &*found;
}

std::vector<SuiteFailure> failures_of(const Suite& suite, std::size_t scenario) {
  const SuiteScenario& what = suite.scenarios[scenario];
  const ScenarioResult& result = suite.results[scenario];
  std::vector<SuiteFailure> failures;
  if (!what.errors.empty()) failures.push_back(of_file(what));
  for (const std::size_t r : result.broken) {
    if (suite.runs[r].failures.empty()) failures.push_back(of_error(suite, r));
  }
  std::ranges::move(beside_expectations(suite, result), std::back_inserter(failures));
  for (std::size_t e = 0; e < result.judgements.size(); ++e) {
    // Expectations of runs without a result are only a consequence.
    const Judgement& judgement = result.judgements[e];
    const bool seen = std::ranges::any_of(
        judgement.broke, [&](std::size_t r) { return !suite.runs[r].observations.empty(); });
    if (!judgement.passed && seen) failures.push_back(of_expectation(suite, scenario, e));
  }
  return failures;
}

}  // namespace footfall::lab
