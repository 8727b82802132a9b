// Report sections on contact: ground forces, utilization of the friction cones, internal forces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "lab/report/sections.h"

namespace footfall::lab {
namespace {

constexpr double kLoaded = 0.05;  // of the largest normal force; meaningless ratios below
constexpr std::size_t kConePoints = 1500;

// Force of one foot, measured (`force.`) or predicted (`force_cmd.`).
struct Force {
  const std::vector<float>*x, *y, *z;
  Force(const Log& log, const std::string& stem)
      : x(log.values(stem + ".x")), y(log.values(stem + ".y")), z(log.values(stem + ".z")) {}
  bool valid() const { return x && y && z && !z->empty(); }
  double tangential(std::size_t row) const {
    return std::hypot(static_cast<double>((*x)[row]), static_cast<double>((*y)[row]));
  }
  double normal(std::size_t row) const { return static_cast<double>((*z)[row]); }
  double loaded() const {
    return kLoaded * static_cast<double>(*std::max_element(z->begin(), z->end()));
  }
};

// Friction utilization |tangential| / (mu normal) of a loaded foot; 1 is slip.
std::vector<float> cone_use(const Force& force, double friction) {
  std::vector<float> out(force.z->size(), std::numeric_limits<float>::quiet_NaN());
  const double least = force.loaded();
  for (std::size_t row = 0; row < out.size(); ++row) {
    if (force.normal(row) <= least || force.normal(row) <= 0.0) continue;
    out[row] = static_cast<float>(force.tangential(row) / (friction * force.normal(row)));
  }
  return out;
}

PlaneCurve cone_points(const Force& force, const std::string& label, const char* colour) {
  PlaneCurve dots{label, colour, Mark::dot, {}, 0.55};
  const double least = force.loaded();
  const std::size_t stride = force.z->size() / kConePoints + 1;
  for (std::size_t row = 0; row < force.z->size(); row += stride) {
    if (force.normal(row) <= least) continue;
    dots.points.push_back({force.tangential(row), force.normal(row)});
  }
  return dots;
}

// Side view of the friction cone: points to the right of the line slip.
PlanePlot cone_plot(const Log& log, const std::string& foot, double friction) {
  PlanePlot plot{"cone-" + foot,
                 "Force in the friction cone, " + spaced(foot),
                 "tangential, N",
                 "normal, N",
                 {},
                 false,
                 1.0};
  double top = 0.0;
  for (const bool measured : {true, false}) {
    const Force force(log, (measured ? "force." : "force_cmd.") + foot);
    if (!force.valid()) continue;
    plot.curves.push_back(
        cone_points(force, measured ? "measured" : "predicted", measured ? "actual" : "plan"));
    for (const Point2& point : plot.curves.back().points) top = std::max(top, point[1]);
  }
  if (top > 0.0) {
    plot.curves.push_back({fmt::format("cone, friction {:.3g}", friction),
                           "c3",
                           Mark::line,
                           {{0.0, 0.0}, {friction * top, top}},
                           1.0});
  }
  return plot;
}

// One curve a foot, and the limit. If the ground's friction is unknown, the ratio itself.
TimePlot use_plot(const Log& log, const std::vector<std::string>& feet, double friction) {
  const bool known = friction > 0.0;
  TimePlot plot{"cone-use",
                known ? "Friction cone used (1: slips)" : "Tangential over normal force",
                "",
                {},
                false};
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const std::string hue = fmt::format("c{}", 1 + i % 5);
    for (const bool measured : {true, false}) {
      const Force force(log, (measured ? "force." : "force_cmd.") + feet[i]);
      if (!force.valid()) continue;
      plot.curves.push_back({spaced(feet[i]) + (measured ? "" : ", predicted"), hue,
                             cone_use(force, known ? friction : 1.0), !measured});
    }
  }
  if (known && !plot.curves.empty()) {
    plot.curves.push_back({"limit", "plan", std::vector<float>(log.rows(), 1.0F), true});
  }
  return plot;
}

}  // namespace

Section force_section(const Log& log) {
  Section section{"forces",
                  "Contact and internal forces",
                  "Ground on robot, z up; dashed: predicted by the control law. The "
                  "cones take up for the normal.",
                  "",
                  {},
                  {}};
  const double friction = std::atof(log.get("friction").c_str());
  const std::vector<std::string> feet = parts(log, "force.", ".z");
  for (const std::string& foot : feet) {
    TimePlot plot{"force-" + foot, spaced(foot), "N", {}, false};
    add_curve(log, plot, "z", "c0", "force." + foot + ".z");
    add_curve(log, plot, "z, predicted", "c0", "force_cmd." + foot + ".z", true);
    add_curve(log, plot, "x", "c1", "force." + foot + ".x");
    add_curve(log, plot, "y", "c2", "force." + foot + ".y");
    keep(section, std::move(plot));
    PlanePlot cone = cone_plot(log, foot, friction);
    if (friction > 0.0 && !cone.curves.empty()) section.planes.push_back(std::move(cone));
  }
  keep(section, use_plot(log, feet, friction));
  for (const std::string& name : parts(log, "internal.", ".measured")) {
    TimePlot plot{"internal-" + name, "Internal force, " + spaced(name), "N", {}, false};
    add_curve(log, plot, "measured", "actual", "internal." + name + ".measured");
    add_curve(log, plot, "reference", "plan", "internal." + name + ".reference", true);
    keep(section, std::move(plot));
  }
  return section;
}

}  // namespace footfall::lab
