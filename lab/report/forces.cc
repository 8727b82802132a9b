// Report sections on contact: ground forces, utilization of the friction cones, internal forces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "lab/report/sections.h"
#include "lab/run/log_setup.h"
#include "model/terrain.h"

namespace footfall::lab {
namespace {

constexpr double kLoaded = 0.05;  // of the largest normal force; meaningless ratios below
constexpr std::size_t kConePoints = 1500;

// Force of one foot, N, measured (`force.`) or predicted (`force_cmd.`): along the normal of the
// ground where the contact point is, and beside it.
struct Force {
  std::vector<double> normal, tangential;

  Force(const Log& log, bool measured, const std::string& foot, const model::Terrain& ground) {
    const std::string stem = (measured ? "force." : "force_cmd.") + foot;
    const auto f = columns(log, stem);
    const auto p = columns(log, "point." + foot);
    if (!f[0] || !f[1] || !f[2]) return;
    for (std::size_t row = 0; row < f[2]->size(); ++row) {
      std::array<double, 3> n = {0.0, 0.0, 1.0}, v{}, place{};
      for (std::size_t k = 0; k < 3; ++k) {
        v[k] = static_cast<double>((*f[k])[row]);
        place[k] = p[k] ? static_cast<double>((*p[k])[row]) : 0.0;
      }
      if (!ground.boxes.empty() && p[0] && p[1] && p[2]) n = ground.nearest(place).normal;
      normal.push_back(v[0] * n[0] + v[1] * n[1] + v[2] * n[2]);
      for (std::size_t k = 0; k < 3; ++k) v[k] -= normal.back() * n[k];
      tangential.push_back(std::hypot(v[0], v[1], v[2]));
    }
  }
  bool valid() const { return !normal.empty(); }
  double loaded() const { return kLoaded * *std::ranges::max_element(normal); }

 private:
  static std::array<const std::vector<float>*, 3> columns(const Log& log, const std::string& stem) {
    return {log.values(stem + ".x"), log.values(stem + ".y"), log.values(stem + ".z")};
  }
};

// Friction utilization |tangential| / (mu normal) of a loaded foot; 1 is slip.
std::vector<float> cone_use(const Force& force, double friction) {
  std::vector<float> out(force.normal.size(), std::numeric_limits<float>::quiet_NaN());
  const double least = force.loaded();
  for (std::size_t row = 0; row < out.size(); ++row) {
    if (force.normal[row] <= least || force.normal[row] <= 0.0) continue;
    out[row] = static_cast<float>(force.tangential[row] / (friction * force.normal[row]));
  }
  return out;
}

PlaneCurve cone_points(const Force& force, const std::string& label, const char* colour) {
  PlaneCurve dots{label, colour, Mark::dot, {}, 0.55};
  const double least = force.loaded();
  const std::size_t stride = force.normal.size() / kConePoints + 1;
  for (std::size_t row = 0; row < force.normal.size(); row += stride) {
    if (force.normal[row] <= least) continue;
    dots.points.push_back({force.tangential[row], force.normal[row]});
  }
  return dots;
}

// Side view of the friction cone: points to the right of the line slip.
PlanePlot cone_plot(const Log& log, const Grounds& grounds, const std::string& foot,
                    double friction) {
  PlanePlot plot{"cone-" + foot,
                 "Force in the friction cone, " + spaced(foot),
                 "tangential, N",
                 "normal, N",
                 {},
                 false,
                 1.0};
  double top = 0.0;
  for (const bool measured : {true, false}) {
    const Force force(log, measured, foot, measured ? grounds.truth : grounds.belief);
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
TimePlot use_plot(const Log& log, const Grounds& grounds, const std::vector<std::string>& feet,
                  double friction) {
  const bool known = friction > 0.0;
  TimePlot plot{"cone-use",
                known ? "Friction cone used (1: slips)" : "Tangential over normal force",
                "",
                {},
                false};
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const std::string hue = fmt::format("c{}", 1 + i % 5);
    for (const bool measured : {true, false}) {
      const Force force(log, measured, feet[i], measured ? grounds.truth : grounds.belief);
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
                  "cones are about the ground's normal where the foot is: the true one, dashed the "
                  "one that the controller believes.",
                  "",
                  {},
                  {}};
  const Grounds grounds = grounds_of(log.setup);
  const double friction = std::atof(log.get("friction").c_str());
  const std::vector<std::string> feet = parts(log, "force.", ".z");
  for (const std::string& foot : feet) {
    TimePlot plot{"force-" + foot, spaced(foot), "N", {}, false};
    add_curve(log, plot, "z", "c0", "force." + foot + ".z");
    add_curve(log, plot, "z, predicted", "c0", "force_cmd." + foot + ".z", true);
    add_curve(log, plot, "x", "c1", "force." + foot + ".x");
    add_curve(log, plot, "y", "c2", "force." + foot + ".y");
    keep(section, std::move(plot));
    PlanePlot cone = cone_plot(log, grounds, foot, friction);
    if (friction > 0.0 && !cone.curves.empty()) section.planes.push_back(std::move(cone));
  }
  keep(section, use_plot(log, grounds, feet, friction));
  for (const std::string& name : parts(log, "internal.", ".measured")) {
    TimePlot plot{"internal-" + name, "Internal force, " + spaced(name), "N", {}, false};
    add_curve(log, plot, "measured", "actual", "internal." + name + ".measured");
    add_curve(log, plot, "reference", "plan", "internal." + name + ".reference", true);
    keep(section, std::move(plot));
  }
  return section;
}

}  // namespace footfall::lab
