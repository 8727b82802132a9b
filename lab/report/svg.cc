// Plots as SVG: planes always, curves over time if the page has no plotting library.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/report/plot.h"

namespace footfall::lab {
namespace {

// Time plots are stretched to the page's width: no text inside, and strokes that do not scale.
constexpr double kTimeWidth = 1000.0, kTimeHeight = 200.0;
constexpr std::size_t kTimePoints = 900;
// Planes keep their aspect ratio; their text is still readable at a width of 300 px.
constexpr double kPlaneWidth = 440.0, kPlaneHeight = 320.0;
constexpr double kLeft = 52.0, kRight = 12.0, kTop = 12.0, kBottom = 40.0;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // Pads the range; gives a useful range even for no or one value.
  void pad(double least_span) {
    if (!(low <= high)) low = high = 0.0;
    const double need = std::max(least_span, 1e-12 * std::max(1.0, std::abs(high)));
    const double more =
        0.5 * std::max(0.0, need - (high - low)) + 0.05 * std::max(high - low, need);
    low -= more;
    high += more;
  }
  void widen(double span) {
    const double more = 0.5 * std::max(0.0, span - (high - low));
    low -= more;
    high += more;
  }
  double span() const { return high - low; }
};

std::string number(double value) {
  return fmt::format("{:.6g}", std::abs(value) < 1e-12 ? 0.0 : value);
}

// Adds a polyline point with one decimal, a tenth of a pixel.
void add_point(std::string& path, bool& pen_down, double x, double y) {
  if (!std::isfinite(x) || !std::isfinite(y)) {
    pen_down = false;
    return;
  }
  path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", x, y);
  pen_down = true;
}

std::string swatch(const std::string& label, const std::string& colour, const std::string& kind) {
  return fmt::format("<span><i class=\"{}\" style=\"color:var(--{})\"></i>{}</span>", kind, colour,
                     escape_html(label));
}

// Maps a plane to picture coordinates, y upwards.
struct PlaneMap {
  Range x, y;
  double width, height;
  double px(double value) const { return kLeft + (value - x.low) / x.span() * width; }
  double py(double value) const { return kTop + (y.high - value) / y.span() * height; }
};

PlaneMap plane_map(const PlanePlot& plot) {
  PlaneMap map{{}, {}, kPlaneWidth - kLeft - kRight, kPlaneHeight - kTop - kBottom};
  for (const PlaneCurve& curve : plot.curves) {
    for (const Point2& point : curve.points) {
      map.x.add(point[0]);
      map.y.add(point[1]);
    }
  }
  map.x.pad(plot.least_span);
  map.y.pad(plot.least_span);
  if (plot.equal_axes) {
    const double scale = std::max(map.x.span() / map.width, map.y.span() / map.height);
    map.x.widen(scale * map.width);
    map.y.widen(scale * map.height);
  }
  return map;
}

std::string plane_axes(const PlanePlot& plot, const PlaneMap& map) {
  std::string out = "<g class=\"grid\">";
  const double bottom = kTop + map.height, right = kLeft + map.width;
  std::string labels;
  for (const double tick : ticks(map.x.low, map.x.high, 6)) {
    out += fmt::format("<path d=\"M{0:.1f} {1}V{2}\"/>", map.px(tick), kTop, bottom);
    labels += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                          map.px(tick), bottom + 15, number(tick));
  }
  for (const double tick : ticks(map.y.low, map.y.high, 5)) {
    out += fmt::format("<path d=\"M{1} {0:.1f}H{2}\"/>", map.py(tick), kLeft, right);
    labels += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", kLeft - 6,
                          map.py(tick) + 4, number(tick));
  }
  out += "</g>" + labels;
  out += fmt::format(
      "<text class=\"axis\" x=\"{:.0f}\" y=\"{}\" text-anchor=\"middle\">{}</text>"
      "<text class=\"axis\" transform=\"translate(12 {:.0f}) rotate(-90)\" "
      "text-anchor=\"middle\">{}</text>",
      kLeft + map.width / 2, kPlaneHeight - 6, escape_html(plot.x_label), kTop + map.height / 2,
      escape_html(plot.y_label));
  return out;
}

std::string plane_curve(const PlaneCurve& curve, const PlaneMap& map) {
  std::string path;
  bool pen_down = false;
  for (const Point2& point : curve.points) {
    const double x = map.px(point[0]), y = map.py(point[1]);
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    switch (curve.mark) {
      case Mark::line:
        add_point(path, pen_down, x, y);
        break;
      case Mark::dot:  // a zero-length line with round caps
        path += fmt::format("M{:.1f} {:.1f}h0", x, y);
        break;
      case Mark::cross:
        path += fmt::format("M{:.1f} {:.1f}l7 7m0 -7l-7 7", x - 3.5, y - 3.5);
        break;
      case Mark::ring:
        path += fmt::format("M{:.1f} {:.1f}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0", x - 4, y);
        break;
      case Mark::square:
        path += fmt::format("M{:.1f} {:.1f}h7v7h-7z", x - 3.5, y - 3.5);
        break;
    }
  }
  if (path.empty()) return "";
  std::string tags;
  if (curve.run >= 0) tags += fmt::format(" data-run=\"{}\"", curve.run);
  if (curve.step > 0) tags += fmt::format(" data-step=\"{}\"", curve.step);
  return fmt::format(
      "<path class=\"{}\"{} style=\"stroke:var(--{})\" opacity=\"{:.2f}\" d=\"{}\"/>",
      curve.mark == Mark::dot ? "dots" : "curve", tags, curve.colour, curve.opacity, path);
}

std::string rectangles(const Grid& grid, const StateBands& bands) {
  std::string out;
  if (grid.time().size() < 2) return out;
  const double from = grid.time().front(), span = grid.time().back() - from;
  for (const StateInterval& interval : bands.intervals) {
    const double begin = std::max(0.0, (interval.begin - from) / span);
    const double end = std::min(1.0, (interval.end - from) / span);
    if (!(end > begin)) continue;
    out += fmt::format(
        "<rect x=\"{:.2f}\" y=\"0\" width=\"{:.2f}\" height=\"{}\" style=\"fill:var(--s{})\"/>",
        begin * kTimeWidth, (end - begin) * kTimeWidth, kTimeHeight,
        band_colour(bands.names[static_cast<std::size_t>(interval.name)], interval.name));
  }
  return out;
}

// Thins again to minimum and maximum of each bucket, at screen resolution.
std::string time_path(const std::vector<double>& time, const std::vector<float>& values,
                      const Range& y) {
  std::string path;
  bool pen_down = false;
  const double from = time.front(), span = std::max(1e-12, time.back() - from);
  const std::size_t stride =
      std::max<std::size_t>(1, (2 * time.size() + kTimePoints - 1) / kTimePoints);
  const auto put = [&](std::size_t i) {
    add_point(path, pen_down, (time[i] - from) / span * kTimeWidth,
              (y.high - static_cast<double>(values[i])) / y.span() * kTimeHeight);
  };
  for (std::size_t i = 0; i < time.size(); i += stride) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(i);
    const auto last =
        values.begin() + static_cast<std::ptrdiff_t>(std::min(i + stride, time.size()));
    const auto [least, most] = std::minmax_element(first, last);
    const auto a = static_cast<std::size_t>(least - values.begin());
    const auto b = static_cast<std::size_t>(most - values.begin());
    put(std::min(a, b));
    if (a != b) put(std::max(a, b));
  }
  return path;
}

std::string tick_labels(const std::vector<double>& places, const Range& range, bool vertical) {
  std::string out;
  for (const double tick : places) {
    const double part = (tick - range.low) / range.span();
    out += fmt::format("<span class=\"{}\" style=\"{}:{:.2f}%\">{}</span>", vertical ? "y" : "x",
                       vertical ? "bottom" : "left", 100.0 * part,
                       number(tick) + (vertical ? "" : " s"));
  }
  return out;
}

}  // namespace

std::string bands_svg(const PlotFrame& frame) {
  return "<svg width=\"0\" height=\"0\" style=\"position:absolute\" aria-hidden=\"true\"><defs>"
         "<g id=\"bands-run\">" +
         rectangles(frame.run, frame.bands) + "</g><g id=\"bands-zoom\">" +
         rectangles(frame.zoom, frame.bands) + "</g></defs></svg>\n";
}

std::string time_plot_svg(const TimePlot& plot, const PlotFrame& frame) {
  const Grid& grid = frame.of(plot);
  if (grid.time().size() < 2) return "";
  const auto [scale, unit] = display_unit(plot.unit, greatest(plot));
  std::vector<std::vector<float>> values;
  Range y, x{grid.time().front(), grid.time().back()};
  for (const Curve& curve : plot.curves) {
    values.push_back(grid.thin(curve.values, scale));
    for (const float value : values.back()) y.add(static_cast<double>(value));
  }
  y.pad(0.0);
  const std::vector<double> rows = ticks(y.low, y.high, 4), columns = ticks(x.low, x.high, 6);
  std::string lines, legend;
  for (const double tick : rows) {
    lines += fmt::format("M0 {:.1f}H{}", (y.high - tick) / y.span() * kTimeHeight, kTimeWidth);
  }
  std::string curves;
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const Curve& curve = plot.curves[i];
    curves += fmt::format("<path class=\"curve{}\" style=\"stroke:var(--{})\" d=\"{}\"/>",
                          curve.dashed ? " dashed" : "", curve.colour,
                          time_path(grid.time(), values[i], y));
    legend += swatch(curve.label, curve.colour, curve.dashed ? "dash" : "line");
  }
  return fmt::format(
      "<figure class=\"plot\"><figcaption>{}<small>{}</small></figcaption>"
      "<div class=\"static\"><svg viewBox=\"0 0 {} {}\" preserveAspectRatio=\"none\" role=\"img\" "
      "aria-label=\"{}\"><use href=\"#bands-{}\"/><path class=\"grid\" d=\"{}\"/>{}</svg>{}{}</div>"
      "<p class=\"legend\">{}</p></figure>\n",
      escape_html(plot.title), escape_html(unit), kTimeWidth, kTimeHeight, escape_html(plot.title),
      plot.zoom ? "zoom" : "run", lines, curves, tick_labels(rows, y, true),
      tick_labels(columns, x, false), legend);
}

std::string plane_plot_svg(const PlanePlot& plot) {
  const PlaneMap map = plane_map(plot);
  std::string curves, legend;
  for (const PlaneCurve& curve : plot.curves) {
    curves += plane_curve(curve, map);
    constexpr std::array<const char*, 5> kKinds = {"line", "dot", "cross", "ring", "square"};
    if (!curve.label.empty() && !curve.points.empty()) {
      legend += swatch(curve.label, curve.colour, kKinds[static_cast<std::size_t>(curve.mark)]);
    }
  }
  return fmt::format(
      "<figure class=\"plane\" id=\"{}\"><figcaption>{}</figcaption>"
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}{}</svg>"
      "<p class=\"legend\">{}</p></figure>\n",
      escape_html(plot.id), escape_html(plot.title), kPlaneWidth, kPlaneHeight,
      escape_html(plot.title), plane_axes(plot, map), curves, legend);
}

}  // namespace footfall::lab
