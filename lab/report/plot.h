// Plots of a report and their HTML: data for uPlot, or SVG. Colours are CSS variables of
// lab/report/web/report.css, so that one page serves light and dark mode.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/text/escape.h"
#include "lab/report/data.h"

namespace footfall::lab {

// Classes of report.css, in the order in which they are assigned to curves.
inline constexpr std::array<const char*, 6> kColours = {"c0", "c1", "c2", "c3", "c4", "c5"};

// One curve over time.
struct Curve {
  std::string label;
  std::string colour;         // style sheet variable: c0 .. c5, actual, plan
  std::vector<float> values;  // at the log's rows, in SI
  bool dashed = false;
  int run = -1;  // index of the run in a comparison
};

// Curves over time with the state bands behind them.
struct TimePlot {
  std::string id;  // unique in the page
  std::string title;
  std::string unit;  // SI, as in the log; small values are displayed in milli-units
  std::vector<Curve> curves;
  bool zoom = false;  // shows only the last steps, at full rate
};

enum class Mark { line, dot, cross, ring, square };

// One point set or line in a plane.
struct PlaneCurve {
  std::string label;  // "": not in the legend
  std::string colour;
  Mark mark = Mark::line;
  std::vector<Point2> points;
  double opacity = 1.0;
  int run = -1;  // index of the run in a comparison
  int step = 0;  // step of a phase portrait, from 1
};

// Curves in a plane, always SVG.
struct PlanePlot {
  std::string id, title;
  std::string x_label, y_label;  // with units
  std::vector<PlaneCurve> curves;
  bool equal_axes = false;
  double least_span = 0.0;  // minimum range of each axis, so that noise is not magnified
};

// An external input or a fault: a line in every plot.
struct PlotMark {
  double time = 0.0;  // s
  std::string kind;   // edit, push, hold, inject, fault
};

// The two time axes of a page, and the bands and marks that all plots share.
struct PlotFrame {
  const Grid& run;
  const Grid& zoom;
  const StateBands& bands;
  const std::vector<PlotMark>& marks;
  const Grid& of(const TimePlot& plot) const { return plot.zoom ? zoom : run; }
};

// A figure with title and unit around an element that the page's script fills from plot_data.
std::string time_plot_html(const TimePlot& plot);
// The same figure as SVG.
std::string time_plot_svg(const TimePlot& plot, const PlotFrame& frame);
// Data of all plots as JSON for the page's script; numbers are base64 of little-endian floats.
std::string plot_data(const std::vector<TimePlot>& plots, const PlotFrame& frame);
std::string plane_plot_svg(const PlanePlot& plot);
// The bands of both axes, defined once; each SVG plot refers to them.
std::string bands_svg(const PlotFrame& frame);
// Legend of the state colours.
std::string bands_legend(const StateBands& bands);

// Display factor and unit for values up to `greatest`: {1000, "mm"} for small lengths.
std::pair<double, std::string> display_unit(const std::string& unit, double greatest);
// Largest finite magnitude over the curves.
double greatest(const TimePlot& plot);
// About `count` axis ticks in [low, high]: multiples of 1, 2 or 5 times a power of ten.
std::vector<double> ticks(double low, double high, int count);

using core::escape_html;
std::string base64(const void* data, std::size_t size);
// Index of the band colour of a state.
int band_colour(const std::string& name, int index);

}  // namespace footfall::lab
