// Several runs on one page; see report.h. All curves are put on the time axis of the longest run.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "core/text/json_text.h"
#include "lab/report/report.h"
#include "lab/report/sections.h"

namespace footfall::lab {
namespace {

using nlohmann::json;

static_assert(kColours.size() == kMaxCompared);
constexpr std::size_t kComparedPoints = 2000;
constexpr std::size_t kSettings = 20;  // maximum number of differing settings shown

char letter(std::size_t run) { return static_cast<char>('A' + run); }

std::string run_name(const Log& log) {
  return run_title(log) + (log.get("seed").empty() ? "" : ", seed " + log.get("seed"));
}

// Row of a run at a time of the common axis: at or just before it; none outside of the run.
class OnAxis {
 public:
  OnAxis(const Log& axis, const Log& log) : rows_(axis.rows(), kNone) {
    if (log.rows() == 0) return;
    const double slack = log.rows() > 1 ? log.time[1] - log.time[0] : 0.0;
    std::size_t row = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double t = axis.time[i] + 1e-9;  // tolerance, so that the same tick is the same row
      while (row + 1 < log.rows() && log.time[row + 1] <= t) ++row;
      if (log.time[row] <= t && t < log.time[row] + slack + 2e-9) rows_[i] = row;
    }
  }
  std::vector<float> operator()(const std::vector<float>& column) const {
    std::vector<float> out(rows_.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (rows_[i] != kNone) out[i] = column[rows_[i]];
    }
    return out;
  }

 private:
  static constexpr auto kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> rows_;
};

struct Overlay {
  const std::vector<ComparedRun>& runs;
  std::vector<OnAxis> places;

  // Adds one signal of all runs that have it, unless it is zero throughout.
  void add(Section& section, const std::string& signal, const std::string& title,
           const std::string& unit) const {
    TimePlot plot{"cmp-" + signal, title, unit, {}, false};
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const auto* values = runs[k].log->values(signal);
      if (values == nullptr) continue;
      plot.curves.push_back(
          {std::string(1, letter(k)), kColours[k], places[k](*values), k > 0, static_cast<int>(k)});
    }
    if (greatest(plot) > 0.0) section.plots.push_back(std::move(plot));
  }

  // parts() over all runs, without duplicates.
  std::vector<std::string> names(std::string_view prefix, std::string_view suffix) const {
    std::vector<std::string> list;
    for (const ComparedRun& run : runs) {
      for (std::string& name : parts(*run.log, prefix, suffix)) {
        if (std::ranges::find(list, name) == list.end()) list.push_back(std::move(name));
      }
    }
    return list;
  }
};

Section motion(const Overlay& overlay) {
  Section section{"motion", "Motion", "", "", {}, {}};
  for (const char* axis : {"x", "y", "z"}) {
    overlay.add(section, std::string("com.pos.") + axis, std::string("Centre of mass, ") + axis,
                "m");
    overlay.add(section, std::string("com.vel.") + axis,
                std::string("Velocity of the centre of mass, ") + axis, "m/s");
  }
  for (const char* angle : {"roll", "pitch", "yaw"}) {
    overlay.add(section, std::string("base.rpy.") + angle, std::string("Torso, ") + angle, "rad");
  }
  return section;
}

Section tasks(const Overlay& overlay) {
  Section section{"tasks", "Task errors", "Magnitude of each task's error.", "", {}, {}};
  for (const std::string& task : overlay.names("task.", ".error")) {
    std::string unit;
    for (const ComparedRun& run : overlay.runs) {
      const int index = run.log->find("task." + task + ".error");
      if (index >= 0) unit = run.log->signals[static_cast<std::size_t>(index)].unit;
    }
    overlay.add(section, "task." + task + ".error", spaced(task), unit.empty() ? "rad" : unit);
  }
  return section;
}

Section torques(const Overlay& overlay) {
  Section section{"torques", "Joint torques", "", "", {}, {}};
  for (const std::string& joint : overlay.names("joint.", ".torque")) {
    overlay.add(section, "joint." + joint + ".torque", spaced(joint), "N m");
  }
  overlay.add(section, "torque.step", "Largest torque step between neighbouring ticks", "N m");
  return section;
}

Section forces(const Overlay& overlay) {
  Section section{"forces", "Contact forces", "Of the ground on the robot, z up.", "", {}, {}};
  for (const std::string& foot : overlay.names("force.", ".z")) {
    overlay.add(section, "force." + foot + ".z", spaced(foot) + ", z", "N");
  }
  for (const std::string& name : overlay.names("internal.", ".measured")) {
    overlay.add(section, "internal." + name + ".measured", "Internal force, " + spaced(name), "N");
  }
  return section;
}

Section path(const std::vector<ComparedRun>& runs) {
  Section section{"path", "Path from above", "Rings: touchdowns.", "", {}, {}};
  PlanePlot plot{"path-top", "Centre of mass and footsteps", "x, m", "y, m", {}, true, 0.1};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Log& log = *runs[k].log;
    const auto *x = log.values("com.pos.x"), *y = log.values("com.pos.y");
    if (x == nullptr || y == nullptr) continue;
    const auto run = static_cast<int>(k);
    PlaneCurve line{std::string(1, letter(k)), kColours[k], Mark::line, {}, 0.9, run};
    const std::size_t stride = x->size() / kComparedPoints + 1;
    for (std::size_t row = 0; row < x->size(); row += stride) {
      line.points.push_back({static_cast<double>((*x)[row]), static_cast<double>((*y)[row])});
    }
    PlaneCurve rings{"", kColours[k], Mark::ring, {}, 0.7, run};
    for (const Touchdown& touch : touchdowns(log)) rings.points.push_back(touch.actual);
    if (rings.points.size() > kFootsteps) {
      rings.points.erase(rings.points.begin(), rings.points.end() - kFootsteps);
    }
    plot.curves.push_back(std::move(line));
    plot.curves.push_back(std::move(rings));
  }
  if (!plot.curves.empty()) section.planes.push_back(std::move(plot));
  return section;
}

// Collects the numbers of a summary by dotted path, in its order.
void add_leaves(const json& value, const std::string& path, std::map<std::string, double>& leaves,
                std::vector<std::string>& order) {
  if (value.is_object()) {
    for (const auto& [key, item] : value.items()) {
      add_leaves(item, path.empty() ? key : path + " " + key, leaves, order);
    }
  } else if (value.is_number() || value.is_boolean()) {
    leaves[path] =
        value.is_boolean() ? static_cast<double>(value.get<bool>()) : value.get<double>();
    if (std::ranges::find(order, path) == order.end()) order.push_back(path);
  }
}

// Metrics side by side, each with its difference from the first run.
Section figures(const std::vector<ComparedRun>& runs) {
  Section section{"figures", "Figures", "In small type: the difference from A.", "", {}, {}};
  std::vector<std::map<std::string, double>> leaves(runs.size());
  std::vector<std::string> order;
  std::string head = "<th>figure</th>";
  for (std::size_t k = 0; k < runs.size(); ++k) {
    add_leaves(core::parse_json(runs[k].summary_json), "", leaves[k], order);
    head += fmt::format("<th>{}</th>", letter(k));
  }
  if (order.empty()) return section;
  std::string rows;
  for (const std::string& name : order) {
    rows += "<tr><th>" + escape_html(spaced(name)) + "</th>";
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const auto own = leaves[k].find(name), first = leaves[0].find(name);
      rows += own == leaves[k].end() ? "<td>-" : fmt::format("<td>{:.5g}", own->second);
      if (k > 0 && own != leaves[k].end() && first != leaves[0].end() &&
          own->second != first->second) {
        rows += fmt::format("<br><small>{:+.3g}</small>", own->second - first->second);
      }
      rows += "</td>";
    }
    rows += "</tr>";
  }
  section.html =
      "<div class=\"wide\" tabindex=\"0\" role=\"group\" aria-label=\"figures\"><table "
      "class=\"figure-table\"><thead><tr>" +
      head + "</tr></thead><tbody>" + rows + "</tbody></table></div>";
  return section;
}

std::string table_of_moments(const std::string& name, const std::string& head,
                             const std::string& rows) {
  return fmt::format(
      "<div class=\"scroll moments\" tabindex=\"0\" role=\"group\" aria-label=\"{}\"><table "
      "class=\"events\"><thead><tr>{}</tr></thead><tbody>{}</tbody></table></div>",
      name, head, rows);
}

Section parting(const std::vector<ComparedRun>& runs) {
  Section section{"parting",
                  "First differences",
                  "The first difference of each kind from A, ordered by time, causes "
                  "first. A row moves all plots to its time.",
                  "",
                  {},
                  {}};
  std::string rows, settings;
  for (std::size_t k = 1; k < runs.size(); ++k) {
    for (const LogDifference& d : runs[k].parting.differences) {
      rows += fmt::format(
          "<tr data-t=\"{0:.4f}\" data-what=\"{2}\"><td>{0:.4f}</td><td>{1}</td><td>{2}</td>"
          "<td>{3}</td></tr>",
          d.time, letter(k), escape_html(d.kind), escape_html(d.text));
    }
    if (runs[k].parting.differences.empty()) {
      section.html += fmt::format("<p class=\"note\">{} is A, tick by tick.</p>", letter(k));
    }
    std::size_t shown = 0;
    for (const std::string& line : runs[k].parting.setup) {
      if (++shown > kSettings) break;
      settings += fmt::format("<tr><th>{}</th><td>{}</td></tr>", letter(k), escape_html(line));
    }
  }
  if (!rows.empty()) {
    section.html += table_of_moments(
        "differences", "<th>time, s</th><th>run</th><th>kind</th><th>A against it</th>", rows);
  }
  if (!settings.empty()) section.html += "<table class=\"keys\">" + settings + "</table>";
  return section;
}

std::string toggles(const std::vector<ComparedRun>& runs) {
  std::string out = "<div class=\"runs\" role=\"group\" aria-label=\"runs\">";
  for (std::size_t k = 0; k < runs.size(); ++k) {
    out += fmt::format(
        "<label><input type=\"checkbox\" checked data-run=\"{}\"><i style=\"border-color:var(--{});"
        "border-top-style:{}\"></i>{}: {}</label>",
        k, kColours[k], k > 0 ? "dashed" : "solid", letter(k), escape_html(run_name(*runs[k].log)));
  }
  return out + "</div>\n";
}

// The marks of all runs, one run after the other, labelled with the run's letter.
Section marks_of_all(const std::vector<ComparedRun>& runs) {
  Section all{"marks", "Edits, pushes and faults", "", "", {}, {}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Section own = mark_section(*runs[k].log);
    if (own.html.empty()) continue;
    all.lead = own.lead;
    all.html += fmt::format("<h3>{}: {}</h3>", letter(k), escape_html(run_name(*runs[k].log)));
    all.html += own.html;
  }
  return all;
}

}  // namespace

std::string compare_html(const std::vector<ComparedRun>& runs, bool static_plots) {
  const auto end = [](const Log& log) { return log.time.empty() ? 0.0 : log.time.back(); };
  const Log* longest = runs.front().log;
  std::vector<PlotMark> marks;
  std::vector<std::string> titles;
  for (const ComparedRun& run : runs) {
    if (end(*run.log) > end(*longest)) longest = run.log;
    std::ranges::copy(run_marks(*run.log), std::back_inserter(marks));
    const std::string name = run_title(*run.log);
    if (std::ranges::find(titles, name) == titles.end()) titles.push_back(name);
  }
  std::ranges::sort(marks, {}, &PlotMark::time);
  Overlay overlay{runs, {}};
  for (const ComparedRun& run : runs) overlay.places.emplace_back(*longest, *run.log);
  const StateBands bands = state_bands(*runs.front().log);
  const Grid axis(*longest, 0, longest->rows(), run_points(*longest, runs.size()));
  const Grid none(*longest, longest->rows(), longest->rows(), 1);
  const bool interactive = has_interactive_plots() && !static_plots;
  return page_html(
      {fmt::format("{}", fmt::join(titles, " · ")),
       fmt::format("{} runs; behind the curves: the states of A", runs.size()), toggles(runs)},
      {figures(runs), parting(runs), marks_of_all(runs), path(runs), motion(overlay),
       tasks(overlay), torques(overlay), forces(overlay)},
      PlotFrame{axis, none, bands, marks}, interactive);
}

}  // namespace footfall::lab
