// Combines sections into one self-contained page; see sections.h.
#include "lab/report/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "lab/report/assets.h"
#include "lab/report/page.h"
#include "lab/report/report.h"

namespace footfall::lab {
namespace {

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

}  // namespace

bool has_interactive_plots() { return !kUplotJs.empty(); }

std::string run_title(const Log& log) {
  std::string name = log.get("behavior", "run");
  name = name.substr(name.find_last_of('/') + 1);
  const std::size_t dot = name.rfind(".yaml");
  return dot == std::string::npos ? name : name.substr(0, dot);
}

std::string spaced(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

void add_curve(const Log& log, TimePlot& plot, const std::string& label, const std::string& hue,
               const std::string& signal, bool dashed) {
  const auto* values = log.values(signal);
  if (values != nullptr) plot.curves.push_back({label, hue, *values, dashed});
}

void keep(Section& section, TimePlot plot) {
  if (greatest(plot) > 0.0) section.plots.push_back(std::move(plot));
}

std::size_t run_points(const Log& log, std::size_t runs) {
  constexpr std::size_t kPageBytes = 3'000'000, kBytes = 6;  // per float in base64, rounded up
  constexpr std::size_t kMost = 6000, kLeast = 800;
  std::size_t curves = 0;
  for (const LoggedSignal& signal : log.signals) {
    for (const char* stem : {"task.", "joint.", "force", "com.", "base.rpy.", "internal."}) {
      curves += signal.name.starts_with(stem) ? 1 : 0;
    }
  }
  return std::clamp(kPageBytes / (kBytes * std::max<std::size_t>(1, curves * runs)), kLeast, kMost);
}

std::string page_html(const PageHead& head, const std::vector<Section>& sections,
                      const PlotFrame& frame, bool interactive) {
  std::string nav, body = head.html;
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
      {.title = head.title,
       .subtitle = head.subtitle,
       .nav = nav,
       .body = body,
       .css = interactive ? joined({kUplotCss, "\n", kReportCss}) : std::string(kReportCss),
       .data = interactive ? plot_data(plots, frame) : "{}",
       .library = interactive ? joined({license, kUplotJs}) : ""});
}

}  // namespace footfall::lab
