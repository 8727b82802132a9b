// Signal patterns; see reference_signals.h. Signals are registered for a robot and a behavior whose
// parts have placeholder names.
#include "apps/reference/reference_signals.h"

#include <fmt/format.h>

#include <vector>

#include "behaviors/compiled/signals.h"

namespace footfall::apps {
namespace {

struct Row {
  std::string stem;               // without the last part
  std::vector<std::string> ends;  // last parts of consecutive signals with the same doc
  std::string unit;
  std::string doc;
};

core::SignalTable symbolic_signals(bool angular) {
  model::RobotDescription robot;
  robot.joints.resize(1);
  robot.joints[0].name = "JOINT";
  robot.contacts.resize(1);
  robot.contacts[0].name = "CONTACT";
  robot.points.resize(1);
  robot.points[0].name = "POINT";
  core::SignalTable table;
  behaviors::register_signals(robot,
                              {{"TASK", {"AXIS"}, {angular ? core::kNone : core::kLength}, false}},
                              {"FORCE"}, {"PLANNER"}, table, true);
  return table;
}

std::string unit_of(const core::SignalInfo& linear, const core::SignalInfo& angular) {
  const auto text = [](core::Dimension dimension, bool angle) {
    std::string unit = core::unit_text(dimension);
    if (angle && unit.starts_with("1/")) return "rad" + unit.substr(1);
    return unit.empty() && angle ? std::string("rad") : unit;
  };
  if (linear.dimension == angular.dimension) return text(linear.dimension, false);
  return text(linear.dimension, false) + " or " + text(angular.dimension, true);
}

}  // namespace

std::string signals_markdown() {
  const core::SignalTable linear = symbolic_signals(false);
  const core::SignalTable angular = symbolic_signals(true);
  std::vector<Row> rows;
  for (int k = 0; k < linear.size(); ++k) {
    const core::SignalInfo& info = linear.info(k);
    const std::size_t dot = info.name.rfind('.');
    const bool dotted = dot != std::string::npos;
    const std::string stem = dotted ? info.name.substr(0, dot) : "";
    const std::string end = dotted ? info.name.substr(dot + 1) : info.name;
    const bool joins =
        !rows.empty() && dotted && rows.back().stem == stem && rows.back().doc == info.doc;
    if (!joins) rows.push_back({stem, {}, unit_of(info, angular.info(k)), info.doc});
    rows.back().ends.push_back(end);
  }
  std::string out =
      "\n## Signals\n\nWhat expressions, logs and reports can name; `footfall signals BEHAVIOR` "
      "lists those of one behavior. `JOINT`, `CONTACT`, `POINT` are the robot's, `TASK`, `FORCE` "
      "(internal) and `PLANNER` the behavior's. Angles are in rad.\n\n"
      "| signal | unit | meaning |\n|---|---|---|\n";
  for (const Row& row : rows) {
    const std::string stem = row.stem.empty() ? "" : row.stem + ".";
    const std::string ends =
        row.ends.size() == 1 ? row.ends[0] : fmt::format("{{{}}}", fmt::join(row.ends, ","));
    out += fmt::format("| `{}{}` | {} | {} |\n", stem, ends, row.unit, row.doc);
  }
  return out;
}

}  // namespace footfall::apps
