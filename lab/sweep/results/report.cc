// The page of a sweep's report, its summary and its worst runs; see report.h.
#include "lab/sweep/results/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "core/text/json_text.h"
#include "lab/report/assets.h"
#include "lab/report/page.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kWorst = 20, kBroken = 10;

std::string sweep_card(const std::string& label, const std::string& value, const std::string& note,
                       const char* kind = "") {
  return fmt::format("<div class=\"card {}\"><b>{}</b><span>{}</span><small>{}</small></div>", kind,
                     value, escape_html(label), escape_html(note));
}

std::size_t count_of(const SweepTable& table, SweepStatus status) {
  return static_cast<std::size_t>(std::ranges::count_if(
      table.rows, [status](const SweepRow& row) { return row.result.status == status; }));
}

// Ranks runs: falls first, earlier ones worse; then by the first figure of merit.
double badness(const SweepRow& row, const std::string& figure) {
  const auto value = [&row](const std::string& name, double otherwise) {
    const auto at = row.figures.find(name);
    return at == row.figures.end() ? otherwise : at->second;
  };
  if (row.result.status == SweepStatus::failed) return 1e9 - value("time_s", 0.0);
  return value(figure, -std::numeric_limits<double>::infinity());
}

std::string settings_text(const SweepRow& row) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  for (const auto& [name, value] : row.values) add(name + " = " + value);
  if (!row.world.empty()) add("world " + row.world);
  if (row.fault != "none") add(row.fault);
  add(fmt::format("seed {}", row.seed));
  return text;
}

// Whether runs that differ only in their seed have equal results; then their number is not
// evidence.
bool seeds_change_nothing(const SweepTable& table) {
  const std::vector<std::string> figures = figures_of_merit(table);
  const auto result = [&figures](const SweepRow& row) {
    std::vector<double> list;
    for (const std::string& name : figures) {
      const auto at = row.figures.find(name);
      list.push_back(at == row.figures.end() ? -1.0 : at->second);
    }
    return list;
  };
  bool repeated = false;
  std::map<std::tuple<std::string, std::string, std::map<std::string, std::string>>,
           const SweepRow*>
      first;
  for (const SweepRow& row : table.rows) {
    if (row.figures.empty()) continue;
    const auto [at, fresh] = first.try_emplace({row.world, row.fault, row.values}, &row);
    if (!fresh && result(*at->second) != result(row)) return false;
    repeated = repeated || !fresh;
  }
  return repeated && !figures.empty();
}

std::string run_row(const SweepRow& row, const std::vector<std::string>& figures) {
  std::string cells;
  for (const std::string& name : figures) {
    const auto at = row.figures.find(name);
    cells += at == row.figures.end() ? "<td></td>" : fmt::format("<td>{:.4g}</td>", at->second);
  }
  const std::string tail = row.result.status > SweepStatus::failed && !row.result.error_tail.empty()
                               ? "<code>" + escape_html(row.result.error_tail) + "</code>"
                               : "";
  return fmt::format("<tr><td>{}</td><td>{}</td>{}<td>{}{}{}<code>{}</code></td></tr>", row.id,
                     sweep_status_name(row.result.status), cells, escape_html(settings_text(row)),
                     row.result.why.empty() ? "" : ": " + escape_html(row.result.why), tail,
                     escape_html(row.command));
}

std::string run_table(const std::vector<const SweepRow*>& rows,
                      const std::vector<std::string>& figures) {
  std::string out =
      "<div class=\"overflow\"><table class=\"worst\"><tr><th>run</th><th>status</th>";
  for (const std::string& name : figures) {
    const std::string unit = figure_unit(name);
    out += fmt::format("<th>{}{}</th>", escape_html(name), unit.empty() ? "" : ", " + unit);
  }
  out += "<th>what, and the command that repeats it</th></tr>";
  for (const SweepRow* row : rows) out += run_row(*row, figures);
  return out + "</table></div>";
}

}  // namespace

Section sweep_summary_section(const SweepTable& table) {
  Section section{"summary", "Summary", "", "", {}, {}};
  const Share share = share_of(table, [](std::size_t) { return true; });
  const auto [low, high] = share.interval();
  const std::size_t pending = count_of(table, SweepStatus::pending);
  const std::size_t done = table.rows.size() - pending;
  const std::size_t broken = done - share.of;
  double cpu = 0.0;
  for (const SweepRow& row : table.rows) cpu += row.result.cpu_time;
  section.html = "<div class=\"cards\">";
  section.html +=
      sweep_card("runs", fmt::format("{} of {}", done, table.identity.runs),
                 done < table.identity.runs ? "repeat the command to continue" : "all done");
  section.html +=
      sweep_card("passed", share.of == 0 ? "–" : fmt::format("{:.1f} %", 100 * share.value()),
                 fmt::format("{} of {}; 95 % interval {:.1f} to {:.1f} %", share.good, share.of,
                             100 * low, 100 * high));
  section.html += sweep_card("broken", std::to_string(broken),
                             broken == 0 ? "no crash, no time-out" : "in no share or figure below",
                             broken == 0 ? "good" : "bad");
  section.html +=
      sweep_card("processor time", fmt::format("{:.1f} min", cpu / 60.0),
                 done == 0 ? "" : fmt::format("{:.2f} s a run", cpu / static_cast<double>(done)));
  section.html += "</div>";
  if (seeds_change_nothing(table)) {
    section.html +=
        "<p class=\"note\">The seed changes nothing here: the worlds have nothing random in them. "
        "Runs that differ in the seed alone are repeats, and intervals are too narrow; a world "
        "with noise gives them a meaning.</p>";
  }
  if (broken == 0) return section;
  std::vector<const SweepRow*> rows;
  for (const SweepRow& row : table.rows) {
    if (row.result.status > SweepStatus::failed && rows.size() < kBroken) rows.push_back(&row);
  }
  section.html +=
      fmt::format("<h3>Broken: the first {} of {}</h3>", rows.size(), broken) + run_table(rows, {});
  return section;
}

Section sweep_worst_section(const SweepTable& table) {
  Section section{"worst",
                  "Worst runs",
                  "Falls first, the earliest at the top, then by the first figure of merit.",
                  "",
                  {},
                  {}};
  const std::vector<std::string> figures = figures_of_merit(table);
  const std::string first = figures.empty() ? std::string() : figures.front();
  std::vector<const SweepRow*> rows;
  for (const SweepRow& row : table.rows) {
    const SweepStatus status = row.result.status;
    if (status == SweepStatus::passed || status == SweepStatus::failed) rows.push_back(&row);
  }
  std::ranges::stable_sort(rows, [&](const SweepRow* a, const SweepRow* b) {
    return badness(*a, first) > badness(*b, first);
  });
  rows.resize(std::min(rows.size(), kWorst));
  std::vector<std::string> columns = {"time_s"};
  columns.insert(columns.end(), figures.begin(), figures.end());
  if (!rows.empty()) section.html = run_table(rows, columns);
  return section;
}

Section sweep_settings_section(const SweepTable& table) {
  Section section{"settings", "Settings", "", "<table class=\"keys\">", {}, {}};
  const auto row = [&section](const std::string& key, const std::string& value) {
    section.html +=
        fmt::format("<tr><th>{}</th><td>{}</td></tr>", escape_html(key), escape_html(value));
  };
  const auto description = core::parse_json(table.identity.description);
  if (description.is_object()) {
    for (const auto& [key, value] : description.items()) {
      const std::string text =
          value.is_string() ? value.get<std::string>() : core::json_text(value);
      if (text.empty() || text == "[]" || key == "groups" || key == "axes") continue;
      row(key, text.size() > 300 ? text.substr(0, 300) + "…" : text);
    }
    for (const nlohmann::json& axis : description.value("axes", nlohmann::json::array())) {
      const std::string text = core::json_text(axis.value("values", nlohmann::json::array()));
      row(axis.value("name", ""), text.size() > 300 ? text.substr(0, 300) + "…" : text);
    }
  }
  row("plan, files, program", fmt::format("{}, {}, {}", table.identity.plan, table.identity.inputs,
                                          table.identity.program));
  row("version", table.identity.version);
  section.html += "</table>";
  return section;
}

std::string sweep_report_html(const SweepTable& table) {
  const std::vector<SweepFactor> factors = sweep_factors(table);
  const std::vector<Section> sections = {
      sweep_summary_section(table),      sweep_share_section(table, factors),
      sweep_map_section(table, factors), sweep_sensitivity_section(table, factors),
      sweep_worst_section(table),        sweep_settings_section(table)};
  ReportPage page;
  for (const Section& section : sections) {
    if (section.html.empty() && section.planes.empty()) continue;
    page.nav += fmt::format("<a href=\"#{}\">{}</a>", section.id, section.title);
    page.body += fmt::format("<section id=\"{}\"><h2>{}</h2>", section.id, section.title);
    if (!section.lead.empty()) page.body += "<p class=\"lead\">" + section.lead + "</p>";
    page.body += section.html;
    if (!section.planes.empty()) {
      page.body += "<div class=\"figures planes\">";
      for (const PlanePlot& plot : section.planes) page.body += plane_plot_svg(plot);
      page.body += "</div>";
    }
    page.body += "</section>\n";
  }
  const auto description = core::parse_json(table.identity.description);
  const auto text = [&description](const char* key) {
    return description.is_object() ? description.value(key, std::string()) : std::string();
  };
  page.title = text("name");
  page.subtitle = "sweep of " + escape_html(text("scenario") + text("behavior"));
  if (!text("doc").empty()) page.subtitle += " · " + escape_html(text("doc"));
  page.subtitle += " · Footfall " + escape_html(table.identity.version);
  page.css = std::string(kReportCss);
  page.footer = "Intervals are Wilson's at 95 %; figures are of runs that passed, in SI.";
  return fill_page(page);
}

}  // namespace footfall::lab
