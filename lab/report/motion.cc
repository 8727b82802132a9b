// Report sections on overall motion: the path from above, and a phase portrait a step ([Kim16] Fig.
// 6: actual in blue, the planner's in red).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/text/json_text.h"
#include "lab/report/sections.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kPathPoints = 4000;
constexpr std::size_t kPortraits = 40;
constexpr std::size_t kPortraitPoints = 60;
constexpr double kMinPhase = 0.06;  // minimum duration of single support that counts as a step, s

double value_at(const std::vector<float>& column, std::size_t row) {
  return static_cast<double>(column[row]);
}

// Single-support phases that are long enough to be steps.
std::vector<SupportPhase> step_phases(const Log& log) {
  std::vector<SupportPhase> phases = single_support(log);
  std::erase_if(phases, [&](const SupportPhase& phase) {
    return log.time[phase.end - 1] - log.time[phase.begin] < kMinPhase;
  });
  return phases;
}

PlaneCurve com_path(const std::vector<float>& x, const std::vector<float>& y) {
  PlaneCurve path{"centre of mass", "actual", Mark::line, {}, 1.0};
  const std::size_t stride = x.size() / kPathPoints + 1;
  for (std::size_t row = 0; row < x.size(); row += stride)
    path.points.push_back({value_at(x, row), value_at(y, row)});
  return path;
}

// Adds the planner's last prediction at the end of each step.
void add_plans(const Log& log, std::vector<PlaneCurve>& curves) {
  PlaneCurve predicted{"predicted centre of mass at the switch", "plan", Mark::cross, {}, 0.9};
  PlaneCurve targets{"foot targets", "plan", Mark::square, {}, 0.9};
  std::vector<SupportPhase> phases = step_phases(log);
  if (phases.size() > kFootsteps) phases.erase(phases.begin(), phases.end() - kFootsteps);
  for (const PlannerColumns& plan : planners(log)) {
    for (const SupportPhase& phase : phases) {
      const std::size_t row = phase.end - 1;
      if (plan.predicts()) {
        const Point2 p = {value_at(*plan.position[0], row), value_at(*plan.position[1], row)};
        if (p != Point2{0.0, 0.0}) predicted.points.push_back(p);
      }
      if (plan.target[0] != nullptr && plan.target[1] != nullptr) {
        const Point2 p = {value_at(*plan.target[0], row), value_at(*plan.target[1], row)};
        if (p != Point2{0.0, 0.0}) targets.points.push_back(p);
      }
    }
  }
  curves.push_back(std::move(targets));
  curves.push_back(std::move(predicted));
}

// World to heading frame: rotates by -yaw.
Point2 turned(double x, double y, double yaw) {
  return {std::cos(yaw) * x + std::sin(yaw) * y, -std::sin(yaw) * x + std::cos(yaw) * y};
}

// Columns that a portrait needs; `valid` if all are there.
struct PortraitColumns {
  const std::vector<float>*x, *y, *vx, *vy, *yaw;
  explicit PortraitColumns(const Log& log)
      : x(log.values("com.pos.x")),
        y(log.values("com.pos.y")),
        vx(log.values("com.vel.x")),
        vy(log.values("com.vel.y")),
        yaw(log.values("base.rpy.yaw")) {}
  bool valid() const { return x && y && vx && vy; }
};

// The text beside the portraits for one step.
struct StepFact {
  double time = 0.0;  // s, end of the step
  std::string text;
};

// Slider that selects one step of the portraits; see report_keys.js.
std::string step_slider(const std::vector<StepFact>& facts) {
  nlohmann::json list = nlohmann::json::array();
  for (const StepFact& fact : facts) list.push_back({{"t", fact.time}, {"text", fact.text}});
  return fmt::format(
      "<p class=\"steps\"><label for=\"step\">step</label><input type=\"range\" id=\"step\" "
      "min=\"0\" max=\"{}\" value=\"0\" data-facts=\"{}\"><output id=\"step-facts\" for=\"step\">"
      "</output><button id=\"step-go\">plots there</button></p>",
      facts.size(), escape_html(core::json_text(list)));
}

// Phase portraits of both axes of the heading frame, one curve per support phase.
class Portraits {
 public:
  explicit Portraits(const Log& log)
      : log_(log), columns_(log), feet_(parts(log, "contact.", "")), plans_(planners(log)) {}

  std::array<PlanePlot, 2> planes{
      PlanePlot{"phase-x", "Forward", "x - foot, m", "velocity, m/s", {}, false, 0.02},
      PlanePlot{"phase-y", "Sideways", "y - foot, m", "velocity, m/s", {}, false, 0.02}};
  std::vector<StepFact> facts;

  // Adds one of `count` phases; nothing if the log has no position of its foot.
  void add(const SupportPhase& phase, std::size_t count) {
    foot_x_ = log_.values("point." + phase.foot + ".x");
    foot_y_ = log_.values("point." + phase.foot + ".y");
    if (foot_x_ == nullptr || foot_y_ == nullptr) return;
    yaw_ = columns_.yaw != nullptr ? value_at(*columns_.yaw, phase.begin) : 0.0;
    const int step = static_cast<int>(facts.size()) + 1;
    const PlaneCurve empty{
        label_of(phase.foot), colour_of(phase.foot), Mark::line, {}, 0.55, -1, step};
    std::array<PlaneCurve, 2> curve = {empty, empty};
    const std::size_t stride = (phase.end - phase.begin) / kPortraitPoints + 1;
    for (std::size_t row = phase.begin; row < phase.end; row += stride) {
      const Point2 p = from_foot(row);
      const Point2 v = turned(value_at(*columns_.vx, row), value_at(*columns_.vy, row), yaw_);
      for (std::size_t k = 0; k < 2; ++k) curve[k].points.push_back({p[k], v[k]});
    }
    for (std::size_t k = 0; k < 2; ++k) planes[k].curves.push_back(std::move(curve[k]));
    const std::size_t end = phase.end - 1;
    facts.push_back({log_.time[end], fmt::format("{} of {}, on the {} until {:.3f} s", step, count,
                                                 phase.foot, log_.time[end])});
    if (!plans_.empty() && plans_[0].predicts()) add_prediction(end, step);
  }

 private:
  // The planner's prediction for the phase's last row, and its difference from the actual state.
  void add_prediction(std::size_t end, int step) {
    const Point2 p = {value_at(*plans_[0].position[0], end), value_at(*plans_[0].position[1], end)};
    if (p == Point2{0.0, 0.0}) return;  // no plan yet
    const Point2 q = turned(p[0] - value_at(*foot_x_, end), p[1] - value_at(*foot_y_, end), yaw_);
    const Point2 v =
        turned(value_at(*plans_[0].velocity[0], end), value_at(*plans_[0].velocity[1], end), yaw_);
    const char* label = any_predicted_ ? "" : "predicted for the switch";
    for (std::size_t k = 0; k < 2; ++k) {
      planes[k].curves.push_back({label, "plan", Mark::cross, {{q[k], v[k]}}, 0.9, -1, step});
    }
    any_predicted_ = true;
    const Point2 reached = from_foot(end);
    facts.back().text += fmt::format("; there, from the prediction: x {:+.1f} mm, y {:+.1f} mm",
                                     1e3 * (reached[0] - q[0]), 1e3 * (reached[1] - q[1]));
  }
  // Position of the centre of mass relative to the stance foot, m, heading frame.
  Point2 from_foot(std::size_t row) const {
    return turned(value_at(*columns_.x, row) - value_at(*foot_x_, row),
                  value_at(*columns_.y, row) - value_at(*foot_y_, row), yaw_);
  }
  // The legend names each foot once.
  std::string label_of(const std::string& foot) {
    if (std::ranges::find(named_, foot) != named_.end()) return "";
    named_.push_back(foot);
    std::string label = "on the " + foot;
    std::ranges::replace(label, '_', ' ');
    return label;
  }
  std::string colour_of(const std::string& foot) const {
    return !feet_.empty() && foot == feet_[0] ? "c1" : "c2";
  }

  const Log& log_;
  PortraitColumns columns_;
  std::vector<std::string> feet_, named_;
  std::vector<PlannerColumns> plans_;
  bool any_predicted_ = false;
  const std::vector<float>*foot_x_ = nullptr, *foot_y_ = nullptr;  // of the current phase
  double yaw_ = 0.0;                                               // rad, at the start of the phase
};

// The figures of the summary: one definition for tile and section.
std::string placement_text(const nlohmann::json& summary) {
  const nlohmann::json figures =
      summary.is_object() ? summary.value("foot_placement_m", nlohmann::json()) : nlohmann::json();
  if (!figures.is_object() || !figures.contains("count")) return "";
  return fmt::format(" Mean distance {:.2f} mm, largest {:.2f} mm over {} steps from {:.3g} s on.",
                     1e3 * figures.value("mean", 0.0), 1e3 * figures.value("max", 0.0),
                     figures.value("count", 0), summary.value("counted_from_s", 0.0));
}

}  // namespace

Section path_section(const Log& log) {
  Section section{"path",
                  "Path from above",
                  "Centre of mass and footsteps, with the planner's predictions.",
                  "",
                  {},
                  {}};
  const auto* x = log.values("com.pos.x");
  const auto* y = log.values("com.pos.y");
  if (x == nullptr || y == nullptr) return section;
  PlanePlot plot{"path-top", "Centre of mass and footsteps", "x, m", "y, m", {}, true, 0.1};
  std::vector<Touchdown> touches = touchdowns(log);
  if (touches.size() > kFootsteps) touches.erase(touches.begin(), touches.end() - kFootsteps);
  const std::vector<std::string> feet = parts(log, "contact.", "");
  for (std::size_t i = 0; i < feet.size(); ++i) {
    std::string label = feet[i];
    std::ranges::replace(label, '_', ' ');
    PlaneCurve steps{label, i == 0 ? "c1" : "c2", Mark::ring, {}, 0.85};
    for (const Touchdown& touch : touches) {
      if (touch.foot == feet[i]) steps.points.push_back(touch.actual);
    }
    plot.curves.push_back(std::move(steps));
  }
  plot.curves.push_back(com_path(*x, *y));
  add_plans(log, plot.curves);
  const auto* goal_x = log.values("goal.x");
  const auto* goal_y = log.values("goal.y");
  if (goal_x != nullptr && goal_y != nullptr && log.rows() > 0) {
    const std::size_t last = log.rows() - 1;
    plot.curves.push_back({"goal at the end",
                           "c3",
                           Mark::cross,
                           {{value_at(*goal_x, last), value_at(*goal_y, last)}},
                           1.0});
  }
  PlanePlot near{"path-com", "Centre of mass alone", "x, m", "y, m", {}, true, 0.02};
  near.curves.push_back(com_path(*x, *y));
  section.planes = {std::move(plot), std::move(near)};
  return section;
}

Section phase_section(const Log& log) {
  Section section{
      "phase",
      "Phase portraits",
      fmt::format("Velocity over position of the centre of mass, relative to the stance "
                  "foot, one curve for each time on one foot (the last {}). Crosses: "
                  "the planner's prediction for its end.",
                  kPortraits),
      "",
      {},
      {}};
  std::vector<SupportPhase> phases = step_phases(log);
  if (!PortraitColumns(log).valid() || phases.empty()) return section;
  if (phases.size() > kPortraits) phases.erase(phases.begin(), phases.end() - kPortraits);
  Portraits portraits(log);
  for (const SupportPhase& phase : phases) portraits.add(phase, phases.size());
  section.html = step_slider(portraits.facts);
  section.planes = {std::move(portraits.planes[0]), std::move(portraits.planes[1])};
  return section;
}

Section planner_section(const Log& log, const nlohmann::json& summary) {
  Section section{"planner",
                  "Planned and actual footsteps",
                  "Touchdown minus the last planned target, and the planner's targets over time.",
                  "",
                  {},
                  {}};
  PlanePlot scatter{"foot-error", "Touchdown minus target", "x, mm", "y, mm", {}, true, 4.0};
  PlanePlot by_step{"foot-error-steps", "Distance to the target", "step", "mm", {}, false, 1.0};
  const std::vector<std::string> feet = parts(log, "contact.", "");
  for (std::size_t i = 0; i < feet.size(); ++i) {
    std::string label = feet[i];
    std::ranges::replace(label, '_', ' ');
    scatter.curves.push_back({label, i == 0 ? "c1" : "c2", Mark::dot, {}, 0.9});
    by_step.curves.push_back({label, i == 0 ? "c1" : "c2", Mark::dot, {}, 0.9});
  }
  int step = 0;
  for (const Touchdown& touch : touchdowns(log)) {
    ++step;
    if (!touch.planned) continue;
    const double dx = 1e3 * (touch.actual[0] - touch.target[0]);
    const double dy = 1e3 * (touch.actual[1] - touch.target[1]);
    const auto foot = static_cast<std::size_t>(std::ranges::find(feet, touch.foot) - feet.begin());
    scatter.curves[foot].points.push_back({dx, dy});
    by_step.curves[foot].points.push_back({static_cast<double>(step), std::hypot(dx, dy)});
  }
  if (std::ranges::any_of(scatter.curves, [](const auto& c) { return !c.points.empty(); })) {
    section.lead += placement_text(summary);
    section.planes = {std::move(scatter), std::move(by_step)};
  }
  for (const PlannerColumns& plan : planners(log)) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (plan.target[k] == nullptr) continue;
      const std::string axis = k == 0 ? "x" : "y";
      TimePlot plot{"plan-" + plan.name + "-" + axis,
                    "Target of " + plan.name + ", " + axis,
                    "m",
                    {{"planned", "plan", *plan.target[k], false}},
                    false};
      for (std::size_t i = 0; i < feet.size() && i < 2; ++i) {
        const auto* point = log.values("point." + feet[i] + "." + axis);
        if (point == nullptr) continue;
        std::string label = feet[i];
        std::ranges::replace(label, '_', ' ');
        plot.curves.push_back({label, i == 0 ? "c1" : "c2", *point, false});
      }
      section.plots.push_back(std::move(plot));
    }
  }
  return section;
}

}  // namespace footfall::lab
