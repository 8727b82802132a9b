// Machine-readable results of a suite: JUnit XML and JSON; see suite.h.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <nlohmann/json.hpp>

#include "core/text/escape.h"
#include "core/text/printable.h"
#include "lab/suite/suite.h"

namespace footfall::lab {
namespace {

using Json = nlohmann::ordered_json;

// Escaped, with these ends of lines: in attributes a plain newline would be read as a blank.
std::string xml(const std::string& text, const char* newline = "&#10;") {
  std::string out;
  const std::string shown = core::printable_lines(text);
  for (std::string_view rest = shown; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    out += core::escape_html(rest.substr(0, end));
    if (end == std::string_view::npos) break;
    out += newline;
    rest.remove_prefix(end + 1);
  }
  return out;
}

struct Counts {
  std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
};

// A test case: passed if nothing of it failed.
struct TestCase {
  std::string name, place;
  double seconds = 0.0;
  std::vector<const SuiteFailure*> failures;
  const char* skipped = nullptr;  // reason
};

// FILE:LINE:COLUMN, FILE:LINE or FILE as attributes.
std::string place_attributes(const std::string& place) {
  std::string file = place, line;
  for (std::size_t end = file.rfind(':'); end != std::string::npos && end + 1 < file.size();
       end = file.rfind(':')) {
    const std::string number = file.substr(end + 1);
    if (number.find_first_not_of("0123456789") != std::string::npos) break;
    line = number;
    file.resize(end);
  }
  return fmt::format(" file=\"{}\"", xml(file)) +
         (line.empty() ? "" : fmt::format(" line=\"{}\"", line));
}

std::string case_xml(const std::string& suite, const TestCase& test, Counts& counts) {
  ++counts.tests;
  const SuiteFailure* first = test.failures.empty() ? nullptr : test.failures.front();
  std::string out = fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"{}",
                                xml(suite), xml(test.name), test.seconds,
                                place_attributes(first != nullptr ? first->place : test.place));
  if (first == nullptr && test.skipped == nullptr) return out + "/>\n";
  if (first == nullptr) {
    ++counts.skipped;
    return out + fmt::format(">\n      <skipped message=\"{}\"/>\n    </testcase>\n", test.skipped);
  }
  ++(first->error ? counts.errors : counts.failures);
  const char* kind = first->error ? "error" : "failure";
  std::string message = first->message, text;
  if (test.failures.size() > 1) message += fmt::format(" (and {} more)", test.failures.size() - 1);
  for (const SuiteFailure* failure : test.failures) text += failure->text;
  return out + fmt::format(">\n      <{} message=\"{}\" type=\"{}\">{}</{}>\n    </testcase>\n",
                           kind, xml(message), xml(first->type), xml(text, "\n"), kind);
}

// The cases of a scenario: of what could not be run, of its runs beside the expectations, and of
// each expectation.
std::vector<TestCase> cases_of(const Suite& suite, std::size_t s,
                               const std::vector<SuiteFailure>& failures) {
  const SuiteScenario& scenario = suite.scenarios[s];
  const char* skipped = has_result(suite, s) ? nullptr : "no run came to its end";
  std::vector<TestCase> cases{{"runs", scenario.path, suite.results[s].wall_time, {}, nullptr}};
  const auto add = [&](const std::string& name, const std::string& place) {
    cases.push_back({name, place, 0.0, {}, skipped});
  };
  if (scenario.errors.empty()) add("end", scenario.path);
  if (scenario.scripted) add("script", scenario.path);
  if (!scenario.golden.empty()) add("golden", scenario.path);
  const std::size_t first = cases.size();
  for (const SuiteExpectation& expected : scenario.expectations) add(expected.text, expected.place);
  for (const SuiteFailure& failure : failures) {
    const auto own = std::ranges::find(cases, failure.type, &TestCase::name);
    TestCase& test = failure.error                   ? cases.front()
                     : failure.type == "expectation" ? cases[first + failure.expectation]
                     : own == cases.end()            ? cases.front()
                                                     : *own;
    test.failures.push_back(&failure);
  }
  return cases;
}

SuiteFailure interrupted(const SuiteScenario& scenario) {
  SuiteFailure failure;
  failure.type = verdict_name(Verdict::stopped);
  failure.error = true;
  failure.place = scenario.path;
  failure.message = "interrupted";
  return failure;
}

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return "localhost";
  return name.data();
}

Json observations_json(const Suite& suite, const SuiteRun& run) {
  Json list = Json::array();
  for (std::size_t e = 0; e < run.observations.size(); ++e) {
    const Observation& seen = run.observations[e];
    list.push_back({{"text", suite.scenarios[run.scenario].expectations[e].text},
                    {"passed", seen.passed},
                    {"value", seen.value.empty() ? Json() : Json(seen.value)},
                    {"at_s", seen.at ? Json(*seen.at) : Json()},
                    {"tick", seen.tick >= 0 ? Json(seen.tick) : Json()},
                    {"state", seen.state.empty() ? Json() : Json(seen.state)},
                    {"why", seen.why.empty() ? Json() : Json(seen.why)}});
  }
  return list;
}

Json run_json(const Suite& suite, const SuiteRun& run) {
  const bool passed = run.verdict == Verdict::passed;
  Json out = {{"seed", run.seed}, {"verdict", verdict_name(run.verdict)}};
  out["why"] = run.why.empty() ? Json() : Json(run.why);
  out["failures"] = failures_json(run.failures);
  out["expectations"] = observations_json(suite, run);
  out["wall_s"] = run.wall_time;
  out["cpu_s"] = run.cpu_time;
  out["rerun"] = rerun_command(suite, run);
  out["stderr"] = passed ? Json() : Json(run.error_tail);
  out["folder"] = passed ? Json() : Json(run.folder);
  out["reports"] = Json::array();
  for (const RunReport& report : run.reports) out["reports"].push_back(report.page);
  return out;
}

Json scenario_json(const Suite& suite, std::size_t s) {
  const SuiteScenario& scenario = suite.scenarios[s];
  const ScenarioResult& result = suite.results[s];
  Json out = {{"name", scenario.name}, {"file", scenario.path}, {"labels", scenario.labels}};
  out["passed"] = result.passed;
  out["complete"] = result.complete;
  out["errors"] = scenario.errors.empty() ? Json() : Json(scenario.errors);
  Json expectations = Json::array();
  for (std::size_t e = 0; e < result.judgements.size(); ++e) {
    Json seeds = Json::array();
    for (const std::size_t r : result.judgements[e].broke) seeds.push_back(suite.runs[r].seed);
    expectations.push_back({{"text", scenario.expectations[e].text},
                            {"place", scenario.expectations[e].place},
                            {"passed", result.judgements[e].passed},
                            {"held", result.judgements[e].held},
                            {"runs", result.judgements[e].of},
                            {"part", scenario.expectations[e].part},
                            {"broke_in_seeds", seeds}});
  }
  out["expectations"] = std::move(expectations);
  Json runs = Json::array();
  for (const SuiteRun& run : suite.runs) {
    if (run.scenario == s) runs.push_back(run_json(suite, run));
  }
  out["runs"] = std::move(runs);
  return out;
}

}  // namespace

std::string junit_xml(const Suite& suite) {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  const std::string host = host_name();
  for (std::size_t s = 0; s < suite.scenarios.size(); ++s) {
    Counts counts;
    std::vector<SuiteFailure> failures = failures_of(suite, s);
    if (!suite.results[s].complete) failures.push_back(interrupted(suite.scenarios[s]));
    std::string cases;
    for (const TestCase& test : cases_of(suite, s, failures)) {
      cases += case_xml(suite.scenarios[s].name, test, counts);
    }
    out += fmt::format(
        "  <testsuite id=\"{}\" package=\"footfall\" name=\"{}\" hostname=\"{}\" timestamp=\"{}\" "
        "tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\">\n    "
        "<properties>\n"
        "      <property name=\"file\" value=\"{}\"/>\n    </properties>\n",
        s, xml(suite.scenarios[s].name), xml(host), suite.started, counts.tests, counts.failures,
        counts.errors, counts.skipped, suite.results[s].wall_time, xml(suite.scenarios[s].path));
    out += cases + "    <system-out/>\n    <system-err/>\n  </testsuite>\n";
  }
  return out + "</testsuites>\n";
}

Json suite_json(const Suite& suite) {
  std::size_t passed = 0;
  Json scenarios = Json::array();
  for (std::size_t s = 0; s < suite.scenarios.size(); ++s) {
    passed += suite.results[s].passed ? 1U : 0U;
    scenarios.push_back(scenario_json(suite, s));
  }
  Json out = {{"started", suite.started},
              {"wall_s", suite.wall_time},
              {"passed", passed == suite.scenarios.size() && !suite.interrupted},
              {"interrupted", suite.interrupted},
              {"counts",
               {{"scenarios", suite.scenarios.size()},
                {"passed", passed},
                {"failed", suite.scenarios.size() - passed},
                {"runs", suite.runs.size()}}}};
  out["scenarios"] = std::move(scenarios);
  out["coverage"] = suite.coverage.to_json();
  return out;
}

}  // namespace footfall::lab
