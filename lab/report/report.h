// The report of a run: one HTML page that works offline, with plots, state bands, portraits and
// tables. After a run, from its log.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/log/diff.h"
#include "lab/log/reader.h"
#include "lab/steps/log_steps.h"

namespace footfall::lab {

// What a page says of the run: the content of its summary.json, may be empty. In a page of a part,
// or without that file, the figures come from the log, and what a clock measured over the whole run
// is left out.
nlohmann::json page_summary(const Log& log, const std::string& summary_json);

struct ReportOptions {
  std::string summary_json;             // text of summary.json, may be empty
  std::string timing_json;              // text of timing.json, may be empty
  std::vector<std::uint8_t> strip_png;  // film strip, may be empty
  std::string strip_caption;            // what it shows
  std::string strip_note;               // why it is empty, e.g. the renderer's error
  std::string diagram_svg;              // state diagram, may be empty
  std::string diagram_note;             // why it is empty
  RunSteps steps{};                     // of the run, may be empty
  bool static_plots = false;            // SVG even if the plotting library is built in
};

// Returns the page; a log without rows gives a page without plots.
std::string report_html(const Log& log, const ReportOptions& options);

// Writes the page. Throws std::runtime_error with one sentence that names the path.
void write_report(const Log& log, const std::string& path, const ReportOptions& options);

// One of several runs in a comparison.
struct ComparedRun {
  const Log* log = nullptr;
  std::string summary_json;  // may be empty
  LogComparison parting;     // divergence from the first run; empty for the first run itself
};
// Two to six runs on one page: metrics side by side, first differences, overlaid curves, marks of
// all runs. The first run is the reference.
std::string compare_html(const std::vector<ComparedRun>& runs, bool static_plots);
inline constexpr std::size_t kMaxCompared = 6;

// Whether the plotting library is built in; otherwise plots are SVG.
bool has_interactive_plots();

}  // namespace footfall::lab
