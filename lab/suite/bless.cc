// Compares traces and updates golden ones; see bless.h.
#include "lab/suite/bless.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/text/whole_file.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;

double end_of(const GoldenTrace& trace) {
  return trace.rows.empty() ? 0.0 : trace.rows.back().time;
}

std::size_t column_of(const GoldenTrace& trace, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(trace.signals, name) - trace.signals.begin());
}

// The largest difference of one signal over the rows that both traces have.
TraceDiff::Signal compare_signal(const GoldenTrace& before, const GoldenTrace& after,
                                 const std::string& name) {
  TraceDiff::Signal out;
  out.name = name;
  const std::size_t a = column_of(before, name), b = column_of(after, name);
  out.only_before = b == after.signals.size();
  out.only_after = a == before.signals.size();
  if (out.only_before || out.only_after) return out;
  for (std::size_t r = 0; r < std::min(before.rows.size(), after.rows.size()); ++r) {
    const double x = before.rows[r].values[a], y = after.rows[r].values[b];
    if (std::isnan(x) && std::isnan(y)) continue;
    const double difference = std::isnan(x - y) ? std::abs(std::isnan(x) ? y : x) : std::abs(x - y);
    if (difference > out.largest) {
      out.largest = difference;
      out.time = before.rows[r].time;
    }
  }
  return out;
}

// Range of a signal's values, to which differences are related.
double scale_of(const GoldenTrace& trace, const std::string& name) {
  const std::size_t k = column_of(trace, name);
  if (k == trace.signals.size()) return 1.0;
  double low = INFINITY, high = -INFINITY;
  for (const GoldenRow& row : trace.rows) {
    if (std::isnan(row.values[k])) continue;
    low = std::min(low, row.values[k]);
    high = std::max(high, row.values[k]);
  }
  return high > low ? high - low : 1.0;
}

std::string diff_text(const TraceDiff& diff) {
  std::string text;
  for (const TraceDiff::Signal& signal : diff.signals) {
    text += signal.only_after    ? fmt::format("  {:<40} new\n", signal.name)
            : signal.only_before ? fmt::format("  {:<40} gone\n", signal.name)
                                 : fmt::format("  {:<40} differs by up to {:.3g}, at {:.3f} s\n",
                                               signal.name, signal.largest, signal.time);
  }
  if (diff.states > 0) {
    text += fmt::format("  {:<40} {} rows, from {:.3f} s on\n", "other states in", diff.states,
                        diff.first_state);
  }
  if (diff.end_before != diff.end_after) {
    text += fmt::format("  {:<40} {:.3f} s, was {:.3f} s\n", "it ends at", diff.end_after,
                        diff.end_before);
  }
  return text;
}

// Reason why a run's trace must not become golden; empty if it may.
std::string objection(const SuiteRun& run) {
  for (const Observation& seen : run.observations) {
    if (!seen.passed) return "an expectation did not hold in it";
  }
  for (const ScenarioFailure& failure : run.failures) {
    if (failure.kind != ScenarioFailure::Kind::golden) return failure.text;
  }
  const bool whole = run.verdict == Verdict::passed || run.verdict == Verdict::failed;
  return whole ? "" : fmt::format("{}: {}", verdict_name(run.verdict), run.why);
}

// nullopt if the trace equals the golden one.
std::optional<Blessing> blessing_of(const Suite& suite, const SuiteRun& run) {
  const SuiteScenario& scenario = suite.scenarios[run.scenario];
  Blessing out{scenario.name, run.folder + "/golden.csv", scenario.golden, "", objection(run)};
  if (!out.refused.empty()) return out;
  try {
    const GoldenTrace after = read_golden(out.from);
    std::error_code ignored;
    if (!fs::exists(out.to, ignored)) {
      out.text = fmt::format("  a new trace: {} signals, {} rows\n", after.signals.size(),
                             after.rows.size());
      return out;
    }
    const TraceDiff diff = diff_traces(read_golden(out.to), after);
    if (diff.same()) return std::nullopt;
    out.text = diff_text(diff);
  } catch (const std::runtime_error& error) {
    out.refused = error.what();
  }
  return out;
}

}  // namespace

TraceDiff diff_traces(const GoldenTrace& before, const GoldenTrace& after) {
  TraceDiff diff;
  std::vector<std::string> names = before.signals;
  for (const std::string& name : after.signals) {
    if (column_of(before, name) == before.signals.size()) names.push_back(name);
  }
  for (const std::string& name : names) {
    TraceDiff::Signal signal = compare_signal(before, after, name);
    if (signal.largest > 0.0 || signal.only_before || signal.only_after) {
      diff.signals.push_back(std::move(signal));
    }
  }
  std::ranges::stable_sort(diff.signals, [&](const auto& a, const auto& b) {
    return a.largest / scale_of(before, a.name) > b.largest / scale_of(before, b.name);
  });
  for (std::size_t r = 0; r < std::min(before.rows.size(), after.rows.size()); ++r) {
    if (before.rows[r].state == after.rows[r].state) continue;
    if (diff.states++ == 0) diff.first_state = before.rows[r].time;
  }
  diff.end_before = end_of(before);
  diff.end_after = end_of(after);
  return diff;
}

std::vector<Blessing> blessings(const Suite& suite) {
  std::vector<Blessing> list;
  for (const SuiteRun& run : suite.runs) {
    const SuiteScenario& scenario = suite.scenarios[run.scenario];
    // Golden traces belong to the first seed.
    if (scenario.golden.empty() || run.seed != scenario.seeds.front()) continue;
    if (auto blessing = blessing_of(suite, run)) list.push_back(std::move(*blessing));
  }
  return list;
}

void bless(const Blessing& blessing) {
  core::write_whole_file(blessing.to, core::read_whole_file(blessing.from));
}

}  // namespace footfall::lab
