// The sections of the report, in order.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/report/plot.h"
#include "lab/steps/log_steps.h"

namespace footfall::lab {

inline constexpr std::size_t kFootsteps = 200;  // number shown, the last ones of a run

struct Section {
  std::string id;  // anchor
  std::string title;
  std::string lead;  // one or two sentences, HTML
  std::string html;  // tables etc., placed before the plots
  std::vector<PlanePlot> planes;
  std::vector<TimePlot> plots;
};

// Each returns a section without plots if the log has no data for it.
Section path_section(const Log& log);
Section phase_section(const Log& log);
Section task_section(const Log& log);
Section posture_section(const Log& log);
Section torque_section(const Log& log);
// Empty unless the run had series-elastic actuators.
Section actuator_section(const Log& log);
// Empty unless an estimator other than the true state ran (lab/report/estimation).
Section estimation_section(const Log& log);
// Figures of the single steps (lab/report/steps); empty without steps.
Section steps_section(const Log& log, const RunSteps& steps);
Section force_section(const Log& log);
Section planner_section(const Log& log, const nlohmann::json& summary);
Section event_section(const Log& log);
// External inputs and faults: edits with the values before, pushes, injected faults, faults.
Section mark_section(const Log& log);
std::vector<PlotMark> run_marks(const Log& log);
// timing: content of timing.json, may be empty.
Section timing_section(const std::string& timing);
// The cards at the top, what they count, and the table of settings. summary: of page_summary().
std::string summary_html(const Log& log, const nlohmann::json& summary);
std::string summary_lead(const Log& log, const nlohmann::json& summary);
std::string settings_html(const Log& log);

// Replaces `_` by blanks: `right_foot` becomes `right foot`.
std::string spaced(std::string name);
// Adds a signal as a curve if the log has it.
void add_curve(const Log& log, TimePlot& plot, const std::string& label, const std::string& hue,
               const std::string& signal, bool dashed = false);
// Adds the plot unless it is zero throughout: then it was never active and is omitted.
void keep(Section& section, TimePlot plot);

// The page's title and subtitle (HTML); html: content before the sections.
struct PageHead {
  std::string title, subtitle, html;
};
std::string page_html(const PageHead& head, const std::vector<Section>& sections,
                      const PlotFrame& frame, bool interactive);
// Points per curve over the whole run, such that a page with so many runs stays below 5 MB.
std::size_t run_points(const Log& log, std::size_t runs);
// The run's title, from the name of the behavior file.
std::string run_title(const Log& log);

}  // namespace footfall::lab
