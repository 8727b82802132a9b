// Success rates, success maps and sensitivities of a sweep's report; see report.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/sweep/results/report.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kMostMaps = 12, kMostPlots = 24;

std::string percent(double part) { return fmt::format("{:.0f} %", 100.0 * part); }

std::string interval_text(const Share& share) {
  const auto [low, high] = share.interval();
  return fmt::format("{:.0f} to {:.0f} %", 100.0 * low, 100.0 * high);
}

bool comparable(const SweepRow& row) { return row.result.status == SweepStatus::passed; }

// Median over the passed runs with this level.
double median_figure(const SweepTable& table, const SweepFactor& factor, int level,
                     const std::string& figure) {
  std::vector<double> values;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (factor.level[r] != level || !comparable(table.rows[r])) continue;
    const auto at = table.rows[r].figures.find(figure);
    if (at != table.rows[r].figures.end()) values.push_back(at->second);
  }
  return quantile_of(std::move(values), 0.5);
}

std::string share_bar(const Share& share) {
  if (share.of == 0) return "";
  const auto [low, high] = share.interval();
  return fmt::format(
      "<span><i style=\"left:{:.1f}%;width:{:.1f}%\"></i><b style=\"left:{:.1f}%\"></b></span>",
      100.0 * low, 100.0 * (high - low), 99.0 * share.value());
}

std::string axis_label(const SweepFactor& factor) {
  return factor.unit.empty() ? factor.name : factor.name + ", " + factor.unit;
}

std::string map_cell(const Share& share, const std::string& where) {
  if (share.of == 0)
    return "<td class=\"none\" title=\"" + escape_html(where) + ": no run\">–</td>";
  const std::string text =
      fmt::format("{}: {} of {} passed, {} (95 % interval {})", where, share.good, share.of,
                  percent(share.value()), interval_text(share));
  return fmt::format("<td style=\"--p:{:.0f}\" title=\"{}\">{}<small>n {}</small></td>",
                     100.0 * share.value(), escape_html(text), percent(share.value()), share.of);
}

// x to the right, y downwards in plan order.
std::string map_html(const SweepTable& table, const SweepFactor& x, const SweepFactor& y) {
  std::string out = fmt::format(
      "<figure><figcaption>{} (rows) against {} (columns)</figcaption>"
      "<div class=\"overflow\"><table class=\"map\"><tr><th></th>",
      escape_html(y.name), escape_html(x.name));
  for (const std::string& level : x.levels) out += "<th>" + escape_html(level) + "</th>";
  out += "</tr>";
  for (std::size_t j = 0; j < y.levels.size(); ++j) {
    out += "<tr><th>" + escape_html(y.levels[j]) + "</th>";
    for (std::size_t i = 0; i < x.levels.size(); ++i) {
      const Share share = share_of(table, [&](std::size_t r) {
        return x.level[r] == static_cast<int>(i) && y.level[r] == static_cast<int>(j);
      });
      out += map_cell(share, fmt::format("{} {}, {} {}", x.name, x.levels[i], y.name, y.levels[j]));
    }
    out += "</tr>";
  }
  return out + "</table></div></figure>";
}

// A figure of merit against a parameter, for passed runs.
struct Samples {
  std::vector<double> x, y;
  std::vector<int> level;
};

Samples samples_of(const SweepTable& table, const SweepFactor& factor, const std::string& figure) {
  Samples samples;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto at = table.rows[r].figures.find(figure);
    if (!comparable(table.rows[r]) || at == table.rows[r].figures.end()) continue;
    samples.x.push_back(factor.number[r]);
    samples.y.push_back(at->second);
    samples.level.push_back(factor.level[r]);
  }
  return samples;
}

PlanePlot sensitivity_plot(const SweepFactor& factor, const std::string& figure,
                           const Samples& samples) {
  PlanePlot plot;
  plot.id = factor.name + "-" + figure;
  plot.title = figure + " against " + factor.name;
  plot.x_label = axis_label(factor);
  const std::string unit = figure_unit(figure);
  plot.y_label = unit.empty() ? figure : figure + ", " + unit;
  PlaneCurve dots{"a run", "c5", Mark::dot, {}, 0.35};
  for (std::size_t k = 0; k < samples.x.size(); ++k) {
    dots.points.push_back({samples.x[k], samples.y[k]});
  }
  PlaneCurve low{"quartiles", "c0", Mark::line, {}, 0.45},
      median{"median", "c0", Mark::line, {}, 1.0};
  PlaneCurve high = low;
  high.label.clear();
  std::vector<std::pair<double, int>> places;  // position and level
  for (std::size_t i = 0; i < factor.levels.size(); ++i) {
    std::vector<double> x;
    for (std::size_t k = 0; k < samples.x.size(); ++k) {
      if (samples.level[k] == static_cast<int>(i)) x.push_back(samples.x[k]);
    }
    if (!x.empty()) places.emplace_back(quantile_of(x, 0.5), static_cast<int>(i));
  }
  std::ranges::sort(places);
  for (const auto& [x, level] : places) {
    std::vector<double> y;
    for (std::size_t k = 0; k < samples.y.size(); ++k) {
      if (samples.level[k] == level) y.push_back(samples.y[k]);
    }
    low.points.push_back({x, quantile_of(y, 0.25)});
    median.points.push_back({x, quantile_of(y, 0.5)});
    high.points.push_back({x, quantile_of(y, 0.75)});
  }
  plot.curves = {std::move(dots), std::move(low), std::move(high), std::move(median)};
  return plot;
}

}  // namespace

Section sweep_share_section(const SweepTable& table, const std::vector<SweepFactor>& factors) {
  Section section{"shares",
                  "Success by value",
                  "Fraction of passed runs for each value, over all values of the others; "
                  "the bar is the 95 % interval. Medians are over passed runs.",
                  "",
                  {},
                  {}};
  if (factors.empty()) return section;
  const std::vector<std::string> figures = figures_of_merit(table);
  section.html =
      "<div class=\"overflow\"><table class=\"shares\"><tr><th></th><th>value</th>"
      "<th>passed</th><th></th><th>interval</th>";
  for (const std::string& name : figures) {
    section.html += fmt::format("<th>{}, median</th>", escape_html(name));
  }
  section.html += "</tr>";
  for (const SweepFactor& factor : factors) {
    for (std::size_t i = 0; i < factor.levels.size(); ++i) {
      const int level = static_cast<int>(i);
      const Share share = share_of(table, [&](std::size_t r) { return factor.level[r] == level; });
      section.html += fmt::format(
          "<tr><td>{}</td><td>{}</td><td>{} of {}</td><td class=\"bar\">{}</td><td>{}</td>",
          i == 0 ? escape_html(factor.name) : "", escape_html(factor.levels[i]), share.good,
          share.of, share_bar(share), share.of == 0 ? "" : interval_text(share));
      for (const std::string& name : figures) {
        const double median = median_figure(table, factor, level, name);
        section.html +=
            std::isfinite(median) ? fmt::format("<td>{:.4g}</td>", median) : "<td></td>";
      }
      section.html += "</tr>";
    }
  }
  section.html += "</table></div>";
  return section;
}

Section sweep_map_section(const SweepTable& table, const std::vector<SweepFactor>& factors) {
  Section section{"maps",
                  "Success maps",
                  "Fraction of passed runs for both values, over all else; n is the number of "
                  "runs. Point at a cell for its interval.",
                  "",
                  {},
                  {}};
  std::size_t maps = 0, pairs = 0;
  std::string html;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    for (std::size_t j = i + 1; j < factors.size(); ++j) {
      ++pairs;
      if (maps >= kMostMaps) continue;
      ++maps;
      html += map_html(table, factors[i], factors[j]);
    }
  }
  if (maps == 0) return section;
  if (pairs > maps) section.lead += fmt::format(" The first {} of {} pairs.", maps, pairs);
  section.html = "<div class=\"figures\">" + html + "</div>";
  return section;
}

Section sweep_sensitivity_section(const SweepTable& table,
                                  const std::vector<SweepFactor>& factors) {
  Section section{"sensitivity",
                  "Sensitivity",
                  "Figures of merit against each parameter, over all else, for passed runs. "
                  "Rank correlation (Spearman): 1 always increasing, -1 always decreasing.",
                  "",
                  {},
                  {}};
  const std::vector<std::string> figures = figures_of_merit(table);
  std::string rows;
  for (const SweepFactor& factor : factors) {
    if (!factor.parameter) continue;
    rows += "<tr><td>" + escape_html(factor.name) + "</td>";
    for (const std::string& figure : figures) {
      const Samples samples = samples_of(table, factor, figure);
      const double rank = rank_correlation(samples.x, samples.y);
      rows += std::isfinite(rank)
                  ? fmt::format("<td>{:+.2f} <small>n {}</small></td>", rank, samples.x.size())
                  : "<td>–</td>";
      if (samples.x.size() >= 2 && section.planes.size() < kMostPlots) {
        section.planes.push_back(sensitivity_plot(factor, figure, samples));
      }
    }
    rows += "</tr>";
  }
  if (rows.empty()) return section;
  section.html = "<div class=\"overflow\"><table class=\"shares\"><tr><th>rank correlation</th>";
  for (const std::string& name : figures) section.html += "<th>" + escape_html(name) + "</th>";
  section.html += "</tr>" + rows + "</table></div>";
  return section;
}

}  // namespace footfall::lab
