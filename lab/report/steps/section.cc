// Section of the report about the single steps: what goes wrong before a fall is seen here first.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "lab/report/sections.h"
#include "lab/steps/fall_chain.h"
#include "lab/steps/step_columns.h"

namespace footfall::lab {
namespace {

// A value a step, held from its touchdown to the next.
std::vector<float> held(const Log& log, const std::vector<StepRow>& rows, double StepRow::*value) {
  std::vector<float> out(log.rows(), std::numeric_limits<float>::quiet_NaN());
  std::size_t next = 0;
  for (std::size_t k = 0; k < log.rows(); ++k) {
    while (next < rows.size() && rows[next].time <= log.time[k]) ++next;
    if (next > 0) out[k] = static_cast<float>(rows[next - 1].*value);
  }
  return out;
}

const StepColumn& column_of(double StepRow::*value) {
  return *std::ranges::find(step_columns(), value, &StepColumn::value);
}

struct StepCurve {
  const char* label;
  double StepRow::*value;
};
struct StepPlot {
  const char* id;
  const char* title;
  std::vector<StepCurve> curves;
};

const std::vector<StepPlot>& step_plots() {
  static const std::vector<StepPlot> plots = {
      {"step-time",
       "Time of a step, and the landing's delay by the swing-time rule",
       {{"since the touchdown before", &StepRow::step_time}, {"delay", &StepRow::extension}}},
      {"step-early", "Touchdown before its time", {{"early", &StepRow::early}}},
      {"step-error",
       "Foot from its target",
       {{"foot", &StepRow::error},
        {"reference from the target", &StepRow::not_reached},
        {"foot from its reference", &StepRow::tracking}}},
      {"step-speed",
       "Speed of the foot before contact",
       {{"horizontal", &StepRow::speed}, {"downward", &StepRow::sink_speed}}},
      {"step-width", "Width of a step", {{"width", &StepRow::width}}},
      {"step-lateral",
       "Speed of the CoM towards the landing foot",
       {{"true", &StepRow::lateral_speed}, {"predicted", &StepRow::lateral_predicted}}},
      {"step-yaw-rate",
       "Yaw rate before and after touchdown",
       {{"before", &StepRow::yaw_rate}, {"after", &StepRow::yaw_rate_after}}},
      {"step-friction",
       "Tangential over normal force, largest on one foot",
       {{"friction", &StepRow::friction}}},
      {"step-slip",
       "Path of loaded feet over the ground",
       {{"on one foot", &StepRow::slip_single}, {"on more", &StepRow::slip_double}}},
      {"step-tilt", "Largest error of roll and pitch", {{"tilt", &StepRow::tilt}}},
  };
  return plots;
}

bool any_value(const std::vector<float>& values) {
  return std::ranges::any_of(values, [](float value) { return std::isfinite(value); });
}

}  // namespace

Section steps_section(const Log& log, const RunSteps& steps) {
  Section section{"steps", "Steps", "", "", {}, {}};
  if (steps.rows.empty() || log.rows() == 0) return section;
  section.lead = fmt::format(
      "One value a touchdown, held to the next; {}. <code>footfall export LOG --steps</code> gives "
      "the table.",
      steps.truth ? "contacts, feet and base as the simulator knows them" : "as estimated");
  if (end_of(log) == "fall") {
    // One item a line: escaping does not keep line ends.
    std::istringstream text(chain_text(steps.rows));
    for (std::string line; std::getline(text, line);) {
      section.html += "<li>" + escape_html(line) + "</li>";
    }
    section.html = "<ul>" + section.html + "</ul>";
  }
  for (const StepPlot& of : step_plots()) {
    TimePlot plot{of.id, of.title, std::string(column_of(of.curves[0].value).unit), {}, false};
    for (std::size_t k = 0; k < of.curves.size(); ++k) {
      std::vector<float> values = held(log, steps.rows, of.curves[k].value);
      if (any_value(values))
        plot.curves.push_back({of.curves[k].label, kColours[k], std::move(values)});
    }
    if (!plot.curves.empty()) keep(section, std::move(plot));
  }
  return section;
}

}  // namespace footfall::lab
