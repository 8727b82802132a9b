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

// In attributes a plain newline would be read as a blank.
std::string xml(const std::string& text) {
  std::string out;
  const std::string shown = core::printable_lines(text);
  for (std::string_view rest = shown; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    out += core::escape_html(rest.substr(0, end));
    if (end == std::string_view::npos) break;
    out += "&#10;";
    rest.remove_prefix(end + 1);
  }
  return out;
}

// A `failure` or `error` element of a test case; nothing for an empty text.
std::string test_case(const std::string& suite, const std::string& name, double seconds,
                      const char* kind, const std::string& message, const std::string& text) {
  std::string out = fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"",
                                xml(suite), xml(name), seconds);
  if (kind == nullptr) return out + "/>\n";
  return out + fmt::format(">\n      <{} message=\"{}\" type=\"{}\">{}</{}>\n    </testcase>\n",
                           kind, xml(message), kind, xml(text), kind);
}

struct Counts {
  std::size_t tests = 0, failures = 0, errors = 0;
};

// The test case for the runs themselves: that they all ended normally.
std::string runs_case(const Suite& suite, std::size_t s, Counts& counts) {
  const SuiteScenario& scenario = suite.scenarios[s];
  const ScenarioResult& result = suite.results[s];
  ++counts.tests;
  const char* kind = nullptr;
  std::string message, text;
  if (!scenario.errors.empty()) {
    kind = "error";
    message = "the scenario file is wrong";
    text = scenario.errors;
  } else if (!result.broken.empty()) {
    kind = "error";
    const SuiteRun& first = suite.runs[result.broken.front()];
    message = fmt::format("seed {}: {}: {}", first.seed, verdict_name(first.verdict), first.why);
    text = failure_text(suite, s);
  } else if (!result.complete) {
    kind = "error";
    message = text = "interrupted";
  }
  counts.errors += kind != nullptr ? 1U : 0U;
  return test_case(scenario.name, "runs", result.wall_time, kind, message, text);
}

std::string expectation_case(const Suite& suite, std::size_t s, std::size_t e, Counts& counts) {
  const SuiteExpectation& expected = suite.scenarios[s].expectations[e];
  const Judgement& judgement = suite.results[s].judgements[e];
  const bool failed = !judgement.passed;
  ++counts.tests;
  counts.failures += failed ? 1U : 0U;
  const std::string message =
      fmt::format("held in {} of {} runs ({})", judgement.held, judgement.of, expected.place);
  return test_case(suite.scenarios[s].name, expected.text, 0.0, failed ? "failure" : nullptr,
                   message, failure_text(suite, s));
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
  out["expectations"] = observations_json(suite, run);
  out["wall_s"] = run.wall_time;
  out["cpu_s"] = run.cpu_time;
  out["rerun"] = rerun_command(suite, run);
  out["stderr"] = passed ? Json() : Json(run.error_tail);
  out["folder"] = passed ? Json() : Json(run.folder);
  out["report"] = run.report.empty() ? Json() : Json(run.report);
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
    std::string cases = runs_case(suite, s, counts);
    for (std::size_t e = 0; e < suite.results[s].judgements.size(); ++e) {
      cases += expectation_case(suite, s, e, counts);
    }
    out += fmt::format(
        "  <testsuite id=\"{}\" package=\"footfall\" name=\"{}\" hostname=\"{}\" timestamp=\"{}\" "
        "tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\">\n    <properties>\n"
        "      <property name=\"file\" value=\"{}\"/>\n    </properties>\n",
        s, xml(suite.scenarios[s].name), xml(host), suite.started, counts.tests, counts.failures,
        counts.errors, suite.results[s].wall_time, xml(suite.scenarios[s].path));
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
