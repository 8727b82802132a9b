// Reads, writes and compares golden traces; see golden_trace.h.
#include "lab/scenario/golden_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "core/text/whole_file.h"
#include "core/units/units.h"

namespace footfall::lab {
namespace {

std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',') {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

// An empty field means that the signal has no value.
double number_in(const std::string& text, const std::string& where) {
  if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem == std::errc() && end == text.data() + text.size()) return value;
  throw std::runtime_error(where + ": error: expected a number, got '" + text + "'");
}

// Number of decimals that resolves a hundredth of the tolerance.
int decimals(double tolerance) {
  return std::clamp(static_cast<int>(std::ceil(2.0 - std::log10(tolerance) - 1e-9)), 0, 15);
}

std::string shown(double value, const std::string& unit) {
  if (std::isnan(value)) return "no value";
  return fmt::format("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

}  // namespace

GoldenTrace read_golden(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": error: cannot be read");
  GoldenTrace trace;
  std::string line;
  for (int number_of_line = 1; std::getline(file, line); ++number_of_line) {
    const std::string where = fmt::format("{}:{}", path, number_of_line);
    std::vector<std::string> fields = csv_fields(line);
    if (number_of_line == 1) {
      if (fields.size() < 3 || fields[0] != "time" || fields[1] != "state") {
        throw std::runtime_error(where + ": error: expected the head 'time,state,SIGNAL,...'");
      }
      trace.signals.assign(fields.begin() + 2, fields.end());
      continue;
    }
    if (line.empty()) continue;
    if (fields.size() != trace.signals.size() + 2) {
      throw std::runtime_error(fmt::format("{}: error: expected {} fields, got {}", where,
                                           trace.signals.size() + 2, fields.size()));
    }
    GoldenRow row{number_in(fields[0], where), fields[1], {}};
    for (std::size_t k = 2; k < fields.size(); ++k)
      row.values.push_back(number_in(fields[k], where));
    trace.rows.push_back(std::move(row));
  }
  if (trace.signals.empty()) throw std::runtime_error(path + ": error: the trace is empty");
  return trace;
}

void write_golden(const std::string& path, const GoldenSpec& spec, const GoldenTrace& trace) {
  std::string text = "time,state";
  for (const std::string& name : trace.signals) text += ',' + name;
  text += '\n';
  for (const GoldenRow& row : trace.rows) {
    text += fmt::format("{:.4f},{}", row.time, row.state);
    for (std::size_t k = 0; k < row.values.size(); ++k) {
      text += ',';
      if (!std::isnan(row.values[k])) {
        text += fmt::format("{:.{}f}", row.values[k], decimals(spec.signals[k].tolerance));
      }
    }
    text += '\n';
  }
  core::write_whole_file(path, text);
}

GoldenMismatch compare_golden(const GoldenSpec& spec, const core::SignalTable& signals,
                              const GoldenTrace& expected, const GoldenTrace& got) {
  std::vector<std::size_t> column;  // column in the expected trace, by signal of this trace
  for (const std::string& name : got.signals) {
    const auto found = std::ranges::find(expected.signals, name);
    if (found == expected.signals.end()) {
      return {fmt::format("the trace has no signal '{}'", name), std::nullopt};
    }
    column.push_back(static_cast<std::size_t>(found - expected.signals.begin()));
  }
  const std::size_t rows = std::min(expected.rows.size(), got.rows.size());
  for (std::size_t r = 0; r < rows; ++r) {
    const GoldenRow& want = expected.rows[r];
    const GoldenRow& have = got.rows[r];
    if (std::abs(want.time - have.time) > 0.5 / spec.rate) {
      return {fmt::format("row {} of the trace is of {:.4f} s, the run's of {:.4f} s: another rate",
                          r + 1, want.time, have.time),
              std::nullopt};
    }
    for (std::size_t k = 0; k < have.values.size(); ++k) {
      const double a = have.values[k], b = want.values[column[k]];
      const double tolerance = spec.signals[k].tolerance;
      if (std::isnan(a) && std::isnan(b)) continue;
      // Tolerate the rounding of the file, too.
      if (std::abs(a - b) <= tolerance + 0.5 * std::pow(10.0, -decimals(tolerance))) continue;
      const std::string unit = core::unit_text(signals.info(spec.signals[k].signal).dimension);
      return {fmt::format("{} at {:.4f} s in {}: got {}, expected {} (in {}), tolerance {}",
                          got.signals[k], have.time, have.state, shown(a, unit), shown(b, unit),
                          want.state, shown(tolerance, unit)),
              have.time};
    }
  }
  if (expected.rows.size() == got.rows.size()) return {};
  const auto end = [](const GoldenTrace& t) { return t.rows.empty() ? 0.0 : t.rows.back().time; };
  return {fmt::format("the run's trace ends at {:.3f} s, the golden one at {:.3f} s", end(got),
                      end(expected)),
          std::min(end(got), end(expected))};
}

GoldenRecorder::GoldenRecorder(const GoldenSpec& spec, const engine::ControlLoop& loop)
    : spec_(spec),
      loop_(loop),
      every_(std::max<std::int64_t>(1, std::llround(1.0 / (spec.rate * loop.period())))) {
  for (const GoldenSignal& signal : spec.signals) {
    trace_.signals.push_back(loop.signals().info(signal.signal).name);
  }
}

void GoldenRecorder::observe() {
  if (loop_.ticks() % every_ != 0) return;
  GoldenRow& row = trace_.rows.emplace_back();
  row.time = loop_.time();
  for (const int s : loop_.machine().active_atomic()) {
    if (!row.state.empty()) row.state += ' ';
    row.state += loop_.behavior().states[static_cast<std::size_t>(s)].path;
  }
  for (const GoldenSignal& signal : spec_.signals) {
    row.values.push_back(loop_.signals()[signal.signal]);
  }
}

}  // namespace footfall::lab
