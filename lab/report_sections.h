// The parts of a report in their order: which curves of the log are drawn where.
#pragma once

#include <string>
#include <vector>

#include "lab/report_plot.h"

namespace footfall::lab {

struct Section {
  std::string id;  // anchor
  std::string title;
  std::string lead;  // one or two sentences, HTML
  std::string html;  // tables and the like, before the plots
  std::vector<PlanePlot> planes;
  std::vector<TimePlot> plots;
};

// Each returns a section without plots where the log has nothing for it.
Section path_section(const Log& log);
Section phase_section(const Log& log);
Section task_section(const Log& log);
Section posture_section(const Log& log);
Section torque_section(const Log& log);
Section force_section(const Log& log);
Section planner_section(const Log& log);
Section event_section(const Log& log);
// timing: text of timing.json, may be empty.
Section timing_section(const std::string& timing);
// The cards at the top and the table of settings. summary: text of summary.json, may be empty.
std::string summary_html(const Log& log, const std::string& summary);
std::string settings_html(const Log& log);

}  // namespace footfall::lab
