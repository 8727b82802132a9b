// Sections of the report about control: tasks, posture and torques over time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/text/escape.h"
#include "core/text/json_text.h"
#include "lab/report/sections.h"

namespace footfall::lab {
namespace {

std::string colour(std::size_t index) { return kColours[index % kColours.size()]; }

// Displays a dimensionless angle as rad, and its second derivative as rad/s².
std::string readable(const std::string& unit) {
  static const std::map<std::string, std::string> names = {
      {"", "rad"}, {"1/s", "rad/s"}, {"1/s^2", "rad/s²"}, {"m/s^2", "m/s²"}, {"Nm", "N m"}};
  const auto found = names.find(unit);
  return found == names.end() ? unit : found->second;
}

std::string unit_of(const Log& log, const std::string& name) {
  const int index = log.find(name);
  return index < 0 ? "" : readable(log.signals[static_cast<std::size_t>(index)].unit);
}

// The name without its side: right_knee and left_knee are both "knee".
std::string without_side(const std::string& joint) {
  for (const char* side : {"right_", "left_"}) {
    if (joint.starts_with(side)) return joint.substr(std::string(side).size());
  }
  return joint;
}

// One plot for each kind of joint, right in c1 and left in c2, commands dashed.
std::vector<TimePlot> joint_plots(const Log& log, bool knees_in_zoom) {
  std::vector<std::string> kinds;
  std::map<std::string, TimePlot> plots;
  for (const std::string& joint : parts(log, "joint.", ".torque")) {
    const std::string kind = without_side(joint);
    if (knees_in_zoom && kind.find("knee") == std::string::npos) continue;
    if (plots.find(kind) == plots.end()) {
      kinds.push_back(kind);
      plots[kind] = {(knees_in_zoom ? "zoom-" : "torque-") + kind,
                     knees_in_zoom ? "Knee torque, last four steps" : "Torque, " + spaced(kind),
                     "N m",
                     {},
                     knees_in_zoom};
    }
    TimePlot& plot = plots[kind];
    const std::string hue = joint.starts_with("right")  ? "c1"
                            : joint.starts_with("left") ? "c2"
                                                        : colour(plot.curves.size());
    add_curve(log, plot, spaced(joint), hue, "joint." + joint + ".torque");
    add_curve(log, plot, spaced(joint) + ", commanded", hue, "joint." + joint + ".command", true);
  }
  std::vector<TimePlot> list;
  for (const std::string& kind : kinds) list.push_back(std::move(plots[kind]));
  return list;
}

void add_task(const Log& log, const std::string& task, Section& section) {
  const std::string stem = "task." + task;
  std::vector<std::string> axes = parts(log, stem + ".measured.", "");
  const std::string unit = unit_of(log, stem + ".error");
  TimePlot error{"error-" + task, spaced(task) + ": error", unit, {}, false};
  TimePlot acceleration{
      "accel-" + task, spaced(task) + ": commanded and achieved acceleration", "", {}, false};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string& axis = axes[i];
    TimePlot track{"track-" + task + "-" + axis, spaced(task) + ", " + axis, unit, {}, false};
    add_curve(log, track, "measured", "actual", stem + ".measured." + axis);
    add_curve(log, track, "reference", "plan", stem + ".reference." + axis, true);
    keep(section, std::move(track));
    add_curve(log, error, axis, colour(i), stem + ".error." + axis);
    acceleration.unit = unit_of(log, stem + ".commanded." + axis);
    add_curve(log, acceleration, axis + " achieved", colour(i), stem + ".achieved." + axis);
    add_curve(log, acceleration, axis + " commanded", colour(i), stem + ".commanded." + axis, true);
  }
  keep(section, std::move(error));
  keep(section, std::move(acceleration));
}

}  // namespace

Section task_section(const Log& log) {
  Section section{"tasks",
                  "Task tracking",
                  "Reference and measured value, error, and the commanded acceleration "
                  "with the one predicted by the control model.",
                  "",
                  {},
                  {}};
  for (const std::string& task : parts(log, "task.", ".error")) add_task(log, task, section);
  return section;
}

Section posture_section(const Log& log) {
  Section section{"posture",
                  "Orientation and height",
                  "Deviation of the torso from the upright posture.",
                  "",
                  {},
                  {}};
  TimePlot tilt{"tilt", "Roll and pitch", "rad", {}, false};
  add_curve(log, tilt, "roll", "c0", "base.rpy.roll");
  add_curve(log, tilt, "pitch", "c1", "base.rpy.pitch");
  keep(section, std::move(tilt));
  TimePlot yaw{"yaw", "Yaw", "rad", {}, false};
  add_curve(log, yaw, "yaw", "c2", "base.rpy.yaw");
  keep(section, std::move(yaw));
  TimePlot height{"height", "Height of the centre of mass", "m", {}, false};
  add_curve(log, height, "measured", "actual", "com.pos.z");
  add_curve(log, height, "reference", "plan", "com.ref.z", true);
  keep(section, std::move(height));
  const auto* z = log.values("com.pos.z");
  const auto* reference = log.values("com.ref.z");
  if (z != nullptr && reference != nullptr) {
    Curve error{"measured - reference", "c0", *z, false};
    for (std::size_t row = 0; row < error.values.size(); ++row)
      error.values[row] -= (*reference)[row];
    section.plots.push_back({"height-error", "Height error", "m", {std::move(error)}, false});
  }
  TimePlot speed{"com-velocity", "Velocity of the centre of mass", "m/s", {}, false};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    add_curve(log, speed, axis, colour(i), "com.vel." + axis);
  }
  keep(section, std::move(speed));
  return section;
}

Section torque_section(const Log& log) {
  Section section{"torques",
                  "Joint torques",
                  "Knee torques over the last four steps show whether contact changes are smooth; "
                  "below, every joint over the whole run.",
                  "",
                  {},
                  {}};
  section.plots = joint_plots(log, true);
  TimePlot zoom_step{"zoom-step", "Largest torque step, last four steps", "N m", {}, true};
  add_curve(log, zoom_step, "torque step", "c3", "torque.step");
  keep(section, std::move(zoom_step));
  for (TimePlot& plot : joint_plots(log, false)) section.plots.push_back(std::move(plot));
  TimePlot step{"torque-step", "Largest torque step between neighbouring ticks", "N m", {}, false};
  add_curve(log, step, "torque step", "c3", "torque.step");
  keep(section, std::move(step));
  return section;
}

namespace {

// rms of command minus measured torque, and the largest motor torque, N m.
std::string joint_figures(const Log& log, const std::string& joint) {
  const auto* torque = log.values("joint." + joint + ".torque");
  const auto* command = log.values("joint." + joint + ".command");
  const auto* motor = log.values("joint." + joint + ".motor");
  if (torque == nullptr || command == nullptr || motor == nullptr || torque->empty()) return "";
  double squared = 0.0, most = 0.0;
  for (std::size_t k = 0; k < torque->size(); ++k) {
    const double error = static_cast<double>((*command)[k]) - static_cast<double>((*torque)[k]);
    squared += error * error;
    most = std::max(most, std::abs(static_cast<double>((*motor)[k])));
  }
  return fmt::format("<td>{:.2f} N m</td><td>{:.0f} N m</td>",
                     std::sqrt(squared / static_cast<double>(torque->size())), most);
}

std::string loop_table(const Log& log, const nlohmann::json& loops) {
  std::string out =
      "<table class=\"keys\"><tr><th>joint</th><th>gains</th><th>bandwidth, output locked</th>"
      "<th>passivity (margin)</th><th>torque error, rms</th><th>motor, peak</th></tr>";
  std::string before;
  for (const auto& loop : loops) {
    const std::string joint = loop.value("joint", "");
    const double margin = loop.value("passivity_margin", 0.0);
    out +=
        fmt::format("<tr><td>{}</td><td>{} ({})</td><td>{:.1f} Hz</td><td>{} ({:.2f})</td>{}</tr>",
                    core::escape_html(spaced(joint)), core::escape_html(loop.value("table", "")),
                    core::escape_html(loop.value("type", "")), loop.value("bandwidth_Hz", 0.0),
                    margin < 0.0 ? "not passive" : "passive", margin,
                    joint == before ? "<td></td><td></td>" : joint_figures(log, joint));
    before = joint;
  }
  return out + "</table>";
}

}  // namespace

Section actuator_section(const Log& log) {
  Section section{"actuators", "Actuators", "", "", {}, {}};
  const auto found = log.run.find("actuators");
  if (found == log.run.end()) return section;
  const nlohmann::json loops = core::parse_json(found->second);
  if (!loops.is_array()) return section;
  section.lead =
      "Series-elastic actuators: the motor's torque beside the spring's, which acts on the joint. "
      "Bandwidth and "
      "passivity are those of the gains at the start, with the nominal spring and without friction "
      "and delay.";
  if (const auto* saturated = log.values("motor.saturated"); saturated && !saturated->empty()) {
    const auto rows = std::ranges::count_if(*saturated, [](float value) { return value > 0.5F; });
    section.lead +=
        fmt::format(" A motor was at its limit in {:.3g} % of the rows.",
                    100.0 * static_cast<double>(rows) / static_cast<double>(saturated->size()));
  }
  section.html = loop_table(log, loops);
  std::string before;
  for (const auto& loop : loops) {
    const std::string joint = loop.value("joint", "");
    if (joint == before) continue;
    before = joint;
    TimePlot plot{"actuator-" + joint, "Last four steps, " + spaced(joint), "N m", {}, true};
    add_curve(log, plot, "commanded", "c3", "joint." + joint + ".command", true);
    add_curve(log, plot, "spring, measured", "c1", "joint." + joint + ".torque");
    add_curve(log, plot, "motor", "c2", "joint." + joint + ".motor");
    keep(section, std::move(plot));
  }
  return section;
}

}  // namespace footfall::lab
