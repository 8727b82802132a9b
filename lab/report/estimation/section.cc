// Section of the report about the estimator: its errors where a simulator told the truth, what it
// thought of itself, and the contacts that it saw.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/text/escape.h"
#include "lab/report/sections.h"

namespace footfall::lab {
namespace {

using EstimateColumn = std::vector<float>;

// An estimated quantity and what it is compared with; names of signals.
struct Estimated {
  std::string label, id, estimate, truth, sigma;
  bool angle = false;
};

std::vector<Estimated> estimated_quantities() {
  std::vector<Estimated> out;
  for (const char* axis : {"roll", "pitch", "yaw"}) {
    const std::string name(axis);
    out.push_back(
        {name, name, "base.rpy." + name, "truth.base.rpy." + name, "estimate.sigma." + name, true});
  }
  for (const char* axis : {"x", "y", "z"}) {
    const std::string name(axis);
    out.push_back({"velocity " + name, "velocity-" + name, "base.vel." + name,
                   "truth.base.vel." + name, "estimate.sigma.velocity." + name});
  }
  for (const char* axis : {"x", "y", "z"}) {
    const std::string name(axis);
    out.push_back({"position " + name, "position-" + name, "base.pos." + name,
                   "truth.base.pos." + name, "estimate.sigma.position." + name});
  }
  return out;
}

bool has_values(const EstimateColumn* column) {
  return column != nullptr &&
         std::ranges::any_of(*column, [](float value) { return std::isfinite(value); });
}

// Estimate minus truth; angles within half a turn.
EstimateColumn error_of(const Log& log, const Estimated& of) {
  const EstimateColumn* const estimate = log.values(of.estimate);
  const EstimateColumn* const truth = log.values(of.truth);
  EstimateColumn error;
  if (!has_values(estimate) || !has_values(truth)) return error;
  for (std::size_t k = 0; k < estimate->size(); ++k) {
    const double difference =
        static_cast<double>((*estimate)[k]) - static_cast<double>((*truth)[k]);
    error.push_back(static_cast<float>(of.angle ? std::remainder(difference, 2.0 * std::numbers::pi)
                                                : difference));
  }
  return error;
}

// The error between twice the standard deviation up and down.
TimePlot error_plot(const Log& log, const Estimated& of, EstimateColumn error) {
  const std::string unit = of.angle ? "rad" : of.label.starts_with("velocity") ? "m/s" : "m";
  TimePlot plot{"estimate-" + of.id, "Error of " + of.label, unit, {}, false};
  if (!error.empty()) plot.curves.push_back({"estimate minus truth", "c1", std::move(error)});
  const EstimateColumn* const sigma = log.values(of.sigma);
  if (!has_values(sigma)) return plot;
  for (const float times : {2.0F, -2.0F}) {
    EstimateColumn bound = *sigma;
    for (float& value : bound) value *= times;
    plot.curves.push_back({times > 0.0F ? "+2σ" : "−2σ", "c3", std::move(bound), true});
  }
  return plot;
}

std::string row_of(const Estimated& of, const EstimateColumn& error, const EstimateColumn* sigma) {
  double squared = 0.0, most = 0.0, within = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < error.size(); ++k) {
    const auto value = static_cast<double>(error[k]);
    if (!std::isfinite(value)) continue;
    ++count;
    squared += value * value;
    most = std::max(most, std::abs(value));
    if (sigma != nullptr && std::abs(value) <= 2.0 * static_cast<double>((*sigma)[k])) ++within;
  }
  if (count == 0) return "";
  const double rms = std::sqrt(squared / static_cast<double>(count));
  const double factor = of.angle ? 180.0 / std::numbers::pi : 1e3;
  const std::string unit = of.angle ? "°" : of.label.starts_with("velocity") ? " mm/s" : " mm";
  return fmt::format("<tr><td>{}</td><td>{:.3g}{}</td><td>{:.3g}{}</td><td>{}</td></tr>", of.label,
                     rms * factor, unit, most * factor, unit,
                     has_values(sigma)
                         ? fmt::format("{:.0f} %", 100.0 * within / static_cast<double>(count))
                         : "");
}

// Biases of a sensor with the true ones, an axis a colour.
TimePlot bias_plot(const Log& log, const std::string& sensor, const std::string& unit) {
  TimePlot plot{"estimate-" + sensor, "Bias of the " + spaced(sensor), unit, {}, false};
  int axis = 0;
  for (const char* name : {"x", "y", "z"}) {
    const std::string tail = sensor + "_bias." + name;
    const std::string hue = kColours[static_cast<std::size_t>(++axis)];
    add_curve(log, plot, name, hue, "estimate." + tail);
    add_curve(log, plot, std::string(name) + ", true", hue, "truth." + tail, true);
  }
  std::erase_if(plot.curves, [](const Curve& curve) { return !has_values(&curve.values); });
  return plot;
}

// Two bands a foot: as estimated and, above it, whether the ground pushes.
TimePlot contact_plot(const Log& log) {
  constexpr float kHigh = 0.8F, kBands = 1.0F;  // of a band, of the distance of two
  TimePlot plot{"estimate-contacts",
                "Contacts, as estimated and true: high while there is one",
                "",
                {},
                false};
  float base = 0.0F;
  std::size_t foot = 0;
  for (const std::string& contact : parts(log, "contact.", "")) {
    const std::string hue = kColours[++foot % kColours.size()];
    for (const bool estimated : {true, false}) {
      const EstimateColumn* const from =
          log.values(estimated ? "contact." + contact : "force." + contact + ".z");
      if (from == nullptr) continue;
      EstimateColumn band;
      for (const float value : *from) band.push_back(base + (value > 0.0F ? kHigh : 0.0F));
      plot.curves.push_back({spaced(contact) + (estimated ? ", estimated" : ", true"), hue,
                             std::move(band), !estimated});
      base += kBands;
    }
  }
  return plot;
}

void keep_if_any(Section& section, TimePlot plot) {
  if (!plot.curves.empty()) keep(section, std::move(plot));
}

}  // namespace

Section estimation_section(const Log& log) {
  Section section{"estimation", "Estimation", "", "", {}, {}};
  if (log.values("estimate.markers") == nullptr) return section;
  section.lead = fmt::format(
      "The state is that of the estimator <b>{}</b>. Errors are estimate minus truth, which only a "
      "simulator knows; dashed lines are twice the standard deviation that the estimator gives "
      "itself.",
      core::escape_html(log.get("estimator", "?")));
  std::string rows;
  for (const Estimated& of : estimated_quantities()) {
    EstimateColumn error = error_of(log, of);
    rows += row_of(of, error, log.values(of.sigma));
    keep_if_any(section, error_plot(log, of, std::move(error)));
  }
  if (!rows.empty()) {
    section.html =
        "<table class=\"keys\"><tr><th>error of</th><th>rms</th><th>largest</th>"
        "<th>within 2σ</th></tr>" +
        rows + "</table>";
  }
  for (const auto& [id, title, unit] :
       {std::array{"innovation.marker", "Innovation of the markers, rms", "m"},
        std::array{"innovation.kinematic", "Innovation of the contacts, largest", ""},
        std::array{"markers", "Markers seen", ""}}) {
    TimePlot plot{"estimate-" + std::string(id), title, unit, {}, false};
    if (has_values(log.values("estimate." + std::string(id)))) {
      add_curve(log, plot, title, "c1", "estimate." + std::string(id));
    }
    keep_if_any(section, std::move(plot));
  }
  keep_if_any(section, bias_plot(log, "gyro", "rad/s"));
  keep_if_any(section, bias_plot(log, "accelerometer", "m/s²"));
  keep_if_any(section, contact_plot(log));
  return section;
}

}  // namespace footfall::lab
