// Puts the page together; see report.h.
#include "lab/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <stdexcept>

#include "lab/report_assets.h"
#include "lab/report_page.h"
#include "lab/report_sections.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kRunPoints = 6000;    // keeps a page of 100 curves below 5 MB
constexpr std::size_t kZoomPoints = 12000;  // four steps, every tick
constexpr std::size_t kZoomSteps = 4;

// Rows of the last steps, from one mark `step` of the counter to the end.
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
    section.lead = "The last steps at equal times; arrows: forces of the ground on the feet.";
    section.html =
        "<div class=\"strip\"><img alt=\"The robot at equal times over the run\" "
        "src=\"data:image/png;base64," +
        base64(options.strip_png.data(), options.strip_png.size()) + "\"></div>";
  } else if (!options.strip_note.empty()) {
    section.html = "<p class=\"note\">No pictures: " + escape_html(options.strip_note) + "</p>";
  }
  return section;
}

bool empty(const Section& section) {
  return section.html.empty() && section.planes.empty() && section.plots.empty();
}

std::string section_html(const Section& section, const PlotFrame& frame, bool interactive) {
  std::string out = fmt::format("<section id=\"{}\"><h2>{}</h2>", section.id, section.title);
  if (!section.lead.empty()) out += "<p class=\"lead\">" + section.lead + "</p>";
  out += section.html;
  if (!section.planes.empty()) {
    out += "<div class=\"figures planes\">";
    for (const PlanePlot& plot : section.planes) out += plane_plot_svg(plot);
    out += "</div>";
  }
  if (!section.plots.empty()) {
    out += bands_legend(frame.bands) + "<div class=\"figures\">";
    for (const TimePlot& plot : section.plots) {
      out += interactive ? time_plot_html(plot) : time_plot_svg(plot, frame);
    }
    out += "</div>";
  }
  return out + "</section>\n";
}

std::string joined(std::initializer_list<std::string_view> texts) {
  std::string out;
  for (const std::string_view text : texts) out += text;
  return out;
}

std::string subtitle(const Log& log) {
  std::string out;
  for (const char* key : {"robot", "world", "backend"}) {
    const std::string value = log.get(key);
    if (!value.empty()) out += (out.empty() ? "" : " · ") + escape_html(value);
  }
  if (!log.get("seed").empty()) out += " · seed " + escape_html(log.get("seed"));
  if (!log.get("version").empty()) out += " · Footfall " + escape_html(log.get("version"));
  return out;
}

// A behavior is known by its file's name.
std::string title(const Log& log) {
  std::string name = log.get("behavior", "run");
  name = name.substr(name.find_last_of('/') + 1);
  const std::size_t dot = name.rfind(".yaml");
  return dot == std::string::npos ? name : name.substr(0, dot);
}

}  // namespace

bool has_interactive_plots() { return !kUplotJs.empty(); }

std::string report_html(const Log& log, const ReportOptions& options) {
  const bool interactive = has_interactive_plots() && !options.static_plots;
  const StateBands bands = state_bands(log);
  const Grid run(log, 0, log.rows(), kRunPoints);
  const Grid zoom(log, log.rows() == 0 ? 0 : zoom_begin(log), log.rows(), kZoomPoints);
  const PlotFrame frame{run, zoom, bands};

  Section summary{"summary", "Summary", "", summary_html(log, options.summary_json), {}, {}};
  Section settings{"settings", "Settings", "", settings_html(log), {}, {}};
  const std::vector<Section> sections = {summary,
                                         film_section(options),
                                         path_section(log),
                                         phase_section(log),
                                         task_section(log),
                                         posture_section(log),
                                         torque_section(log),
                                         force_section(log),
                                         planner_section(log),
                                         event_section(log),
                                         timing_section(options.timing_json),
                                         settings};
  std::string nav, body;
  std::vector<TimePlot> plots;
  for (const Section& section : sections) {
    if (empty(section)) continue;
    nav += fmt::format("<a href=\"#{}\">{}</a>", section.id, section.title);
    body += section_html(section, frame, interactive);
    plots.insert(plots.end(), section.plots.begin(), section.plots.end());
  }
  if (!interactive) body = bands_svg(frame) + body;
  const std::string license =
      interactive ? joined({"/* uPlot\n", kUplotLicense, "*/\n"}) : std::string();
  return fill_page(
      {.title = title(log),
       .subtitle = subtitle(log),
       .nav = nav,
       .body = body,
       .css = interactive ? joined({kUplotCss, "\n", kReportCss}) : std::string(kReportCss),
       .data = interactive ? plot_data(plots, frame) : "{}",
       .library = interactive ? joined({license, kUplotJs}) : ""});
}

void write_report(const Log& log, const std::string& path, const ReportOptions& options) {
  std::ofstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot write the report '" + path + "'");
  file << report_html(log, options);
  file.close();
  if (!file) throw std::runtime_error("cannot write the report '" + path + "'");
}

}  // namespace footfall::lab
