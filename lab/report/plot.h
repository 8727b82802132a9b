// Plots of a report: what is drawn, and how it becomes HTML: data for uPlot, or SVG. Colours are
// CSS variables of lab/report/web/report.css, so that light and dark are one page.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/text/escape.h"
#include "lab/report/data.h"

namespace footfall::lab {

// Classes of report.css, in the order in which curves take them.
inline constexpr std::array<const char*, 6> kColours = {"c0", "c1", "c2", "c3", "c4", "c5"};

// One curve over time.
struct Curve {
  std::string label;
  std::string colour;         // a variable of the style sheet: c0 .. c5, actual, plan
  std::vector<float> values;  // on the log's rows, in SI
  bool dashed = false;
  int run = -1;  // of several logs, which
};

// Curves over time with the state bands behind them.
struct TimePlot {
  std::string id;  // unique in the page
  std::string title;
  std::string unit;  // SI, as in the log; small values are shown in milli-units
  std::vector<Curve> curves;
  bool zoom = false;  // only the last steps, at full rate
};

enum class Mark { line, dot, cross, ring, square };

// One set of points or line in a plane.
struct PlaneCurve {
  std::string label;  // "" : not in the legend
  std::string colour;
  Mark mark = Mark::line;
  std::vector<Point2> points;
  double opacity = 1.0;
  int run = -1;  // of several logs, which
  int step = 0;  // of a phase portrait, which, from 1 on
};

// Curves in a plane, always SVG.
struct PlanePlot {
  std::string id, title;
  std::string x_label, y_label;  // with units
  std::vector<PlaneCurve> curves;
  bool equal_axes = false;
  double least_span = 0.0;  // of each axis, so that noise is not blown up
};

// Something that reached the run, or went wrong in it: a line in every plot.
struct PlotMark {
  double time = 0.0;  // s
  std::string kind;   // edit, push, hold, inject, fault
};

// The two time axes of a page, and what is behind and over all curves.
struct PlotFrame {
  const Grid& run;
  const Grid& zoom;
  const StateBands& bands;
  const std::vector<PlotMark>& marks;
  const Grid& of(const TimePlot& plot) const { return plot.zoom ? zoom : run; }
};

// A figure with a title and its unit around a place that the page's script fills from plot_data.
std::string time_plot_html(const TimePlot& plot);
// The same figure, drawn.
std::string time_plot_svg(const TimePlot& plot, const PlotFrame& frame);
// Data of all plots as JSON for the page's script; numbers are base64 of little-endian floats.
std::string plot_data(const std::vector<TimePlot>& plots, const PlotFrame& frame);
std::string plane_plot_svg(const PlanePlot& plot);
// The bands of both axes, drawn once; each SVG plot refers to them.
std::string bands_svg(const PlotFrame& frame);
// Coloured names of the states.
std::string bands_legend(const StateBands& bands);

// Factor and unit in which values up to `greatest` read well: {1000, "mm"} for small lengths.
std::pair<double, std::string> display_unit(const std::string& unit, double greatest);
// Greatest finite magnitude over the curves.
double greatest(const TimePlot& plot);
// Places for about `count` ticks: multiples of 1, 2 or 5 times a power of ten in [low, high].
std::vector<double> ticks(double low, double high, int count);

using core::escape_html;
std::string base64(const void* data, std::size_t size);
// Number of the band colour of a state's name.
int band_colour(const std::string& name, int index);

}  // namespace footfall::lab
