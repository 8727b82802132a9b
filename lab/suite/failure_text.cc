// Textual description of a suite's failures; see suite.h.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

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
  if (seen.at) {
    text += fmt::format("{}at {:.3f} s", text.empty() ? "" : ", ", *seen.at);
    if (seen.tick >= 0) text += fmt::format(" (tick {})", seen.tick);
  }
  if (!seen.state.empty()) text += " in " + seen.state;
  return text.empty() ? "it did not hold" : text;
}

// How to repeat one run.
std::string again(const Suite& suite, const SuiteRun& run) {
  std::string text = fmt::format("    rerun     {}\n", rerun_command(suite, run));
  if (!run.report.empty()) text += fmt::format("    report    {}\n", run.report);
  return text;
}

std::string broken_text(const Suite& suite, const SuiteRun& run) {
  std::string text =
      fmt::format("    expected  {} (seed {})\n",
                  run.verdict == Verdict::failed
                      ? "a normal end, within the tolerances of the golden trace if there is one"
                      : "a run to its end",
                  run.seed);
  text += fmt::format("    happened  {}: {}\n", verdict_name(run.verdict), run.why);
  if (!run.error_tail.empty()) text += indented(run.error_tail);
  return text + again(suite, run);
}

std::string unmet_text(const Suite& suite, const SuiteExpectation& expected,
                       const Judgement& judgement) {
  std::string text = fmt::format("    expected  {}  ({})\n", expected.text, expected.place);
  const auto first = std::ranges::find_if(
      judgement.broke, [&](std::size_t r) { return !suite.runs[r].observations.empty(); });
  std::string what = "no run came to an end";
  const std::size_t shown = first == judgement.broke.end() ? judgement.broke.front() : *first;
  const SuiteRun& run = suite.runs[shown];
  if (first != judgement.broke.end()) {
    const auto e =
        static_cast<std::size_t>(&judgement - suite.results[run.scenario].judgements.data());
    what = observed(run.observations[e]);
  }
  text += fmt::format("    happened  seed {}: {}\n", run.seed, what);
  if (judgement.of > 1) {
    text += fmt::format("    seeds     held in {} of {}, not in {}\n", judgement.held, judgement.of,
                        seeds_text(suite, judgement.broke));
  }
  return text + again(suite, run);
}

}  // namespace

std::string rerun_command(const Suite& suite, const SuiteRun& run) {
  return shell_line(
      {"footfall", "run", suite.scenarios[run.scenario].path, "--seed", std::to_string(run.seed)});
}

std::optional<double> moment_of(const SuiteRun& run) {
  std::optional<double> first;
  for (const Observation& seen : run.observations) {
    if (!seen.passed && seen.at && (!first || *seen.at < *first)) first = seen.at;
  }
  return first;
}

std::string failure_text(const Suite& suite, std::size_t scenario) {
  const SuiteScenario& what = suite.scenarios[scenario];
  const ScenarioResult& result = suite.results[scenario];
  std::string text;
  if (!what.errors.empty()) text += indented(what.errors);
  for (std::size_t e = 0; e < result.judgements.size(); ++e) {
    // If no run completed, that is the failure; expectations not observed are only a consequence.
    const Judgement& judgement = result.judgements[e];
    const bool seen = std::ranges::any_of(
        judgement.broke, [&](std::size_t r) { return !suite.runs[r].observations.empty(); });
    if (!judgement.passed && seen) text += unmet_text(suite, what.expectations[e], judgement);
  }
  for (const std::size_t r : result.broken) text += broken_text(suite, suite.runs[r]);
  return text;
}

}  // namespace footfall::lab
