// Assembles the page; see report.h.
#include "lab/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/text/json_text.h"
#include "lab/figures/log_figures.h"
#include "lab/report/sections.h"
#include "lab/run/summary.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kZoomPoints = 12000;  // four steps at every tick
constexpr std::size_t kZoomSteps = 4;

// First row of the last steps, given by the step counter.
std::size_t zoom_begin(const Log& log) {
  const auto* steps = log.values("steps");
  if (steps == nullptr || steps->empty()) return 0;
  const float last = steps->back();
  std::size_t row = log.rows() - 1;
  while (row > 0 && (*steps)[row - 1] > last - static_cast<float>(kZoomSteps) - 0.5F) --row;
  return last < 1.0F ? 0 : row;
}

Section film_section(const ReportOptions& options) {
  Section section{"film", "Film", "", "", {}, {}};
  if (!options.strip_png.empty()) {
    section.lead =
        escape_html(options.strip_caption) + ". Arrows: forces of the ground on the feet.";
    section.html =
        "<div class=\"strip\" tabindex=\"0\"><img alt=\"The robot at equal times over the run\" "
        "src=\"data:image/png;base64," +
        base64(options.strip_png.data(), options.strip_png.size()) + "\"></div>";
  } else if (!options.strip_note.empty()) {
    section.html = "<p class=\"note\">No pictures: " + escape_html(options.strip_note) + "</p>";
  }
  return section;
}

std::string subtitle(const Log& log) {
  std::string out;
  for (const char* key : {"robot", "world", "backend"}) {
    const std::string value = log.get(key);
    if (!value.empty()) out += (out.empty() ? "" : " · ") + escape_html(value);
  }
  const std::string aids = log.get("constraints");
  if (!aids.empty()) out += " · aided by " + escape_html(aids);
  if (!log.get("seed").empty()) out += " · seed " + escape_html(log.get("seed"));
  if (!log.get("version").empty()) out += " · Footfall " + escape_html(log.get("version"));
  return out;
}

Section state_section(const ReportOptions& options) {
  Section section{"states", "State diagram", "", "", {}, {}};
  if (!options.diagram_svg.empty()) {
    section.lead =
        "Time spent in each state, its share, and the number of entries; the darker, the "
        "longer.";
    const std::size_t svg = std::min(options.diagram_svg.find("<svg"), options.diagram_svg.size());
    section.html =
        "<div class=\"diagram\" tabindex=\"0\" role=\"group\" aria-label=\"state "
        "diagram\">" +
        options.diagram_svg.substr(svg) + "</div>";
  } else if (!options.diagram_note.empty()) {
    section.html = "<p class=\"note\">No diagram: " + escape_html(options.diagram_note) + "</p>";
  }
  return section;
}

nlohmann::json fault_counts(const Log& log) {
  std::map<std::string, int> counts;
  for (const LoggedEvent& event : log.events) {
    if (event.kind == "fault") ++counts[event.name];
  }
  return counts;
}

}  // namespace

nlohmann::json page_summary(const Log& log, const std::string& summary_json) {
  nlohmann::json summary = core::parse_json(summary_json);
  if (!summary.is_object()) summary = nlohmann::json::object();
  if (!log.part && summary.contains("error")) return summary;
  summary.update(nlohmann::json(figures_json(log_figures(log))));
  summary["faults"] = fault_counts(log);
  for (const char* key : {"fault_ticks", "worst_fault", "tick_us", "allocations",
                          "real_time_factor", "end_torque_step_Nm", "marked_steps"}) {
    summary.erase(key);
  }
  return summary;
}

std::string report_html(const Log& log, const ReportOptions& options) {
  const bool interactive = has_interactive_plots() && !options.static_plots;
  const StateBands bands = state_bands(log);
  const Grid run(log, 0, log.rows(), run_points(log, 1));
  const Grid zoom(log, log.rows() == 0 ? 0 : zoom_begin(log), log.rows(), kZoomPoints);
  const std::vector<PlotMark> marks = run_marks(log);
  const PlotFrame frame{run, zoom, bands, marks};

  const nlohmann::json figures = core::parse_json(options.summary_json);
  Section summary{"summary", "Summary", summary_lead(log, figures), summary_html(log, figures),
                  {},        {}};
  Section settings{"settings", "Settings", "", settings_html(log), {}, {}};
  const std::vector<Section> sections = {summary,
                                         film_section(options),
                                         mark_section(log),
                                         path_section(log),
                                         steps_section(log, options.steps),
                                         phase_section(log),
                                         task_section(log),
                                         posture_section(log),
                                         torque_section(log),
                                         actuator_section(log),
                                         estimation_section(log),
                                         force_section(log),
                                         planner_section(log, figures),
                                         state_section(options),
                                         event_section(log),
                                         timing_section(options.timing_json),
                                         settings};
  return page_html({run_title(log), subtitle(log), ""}, sections, frame, interactive);
}

void write_report(const Log& log, const std::string& path, const ReportOptions& options) {
  core::write_whole_file(path, report_html(log, options));
}

}  // namespace footfall::lab
