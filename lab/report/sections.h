// The parts of a report in their order: which curves of the log are drawn where.
#pragma once

#include <string>
#include <vector>

#include "lab/report/plot.h"

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
// What reached the run from outside and what went wrong: edits with the values before, pushes,
// injected faults, faults.
Section mark_section(const Log& log);
std::vector<PlotMark> run_marks(const Log& log);
// timing: text of timing.json, may be empty.
Section timing_section(const std::string& timing);
// The cards at the top and the table of settings. summary: text of summary.json, may be empty.
std::string summary_html(const Log& log, const std::string& summary);
std::string settings_html(const Log& log);

// right_foot: `right foot`.
std::string spaced(std::string name);
// A signal as a curve, if the log has it.
void add_curve(const Log& log, TimePlot& plot, const std::string& label, const std::string& hue,
               const std::string& signal, bool dashed = false);
// What was zero all the time was never active: a plot of it would only lengthen the page.
void keep(Section& section, TimePlot plot);

// The page's name and what is said below it (HTML); html: before the sections.
struct PageHead {
  std::string title, subtitle, html;
};
std::string page_html(const PageHead& head, const std::vector<Section>& sections,
                      const PlotFrame& frame, bool interactive);
// Points of a curve over the whole run that keep a page of so many runs below 5 MB.
std::size_t run_points(const Log& log, std::size_t runs);
// A behavior is known by its file's name.
std::string run_title(const Log& log);

}  // namespace footfall::lab
