// The figures of a step, in words; see step_columns.h.
#include "lab/steps/step_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace footfall::lab {
namespace {

constexpr std::array kStepColumns = {
    StepColumn{"step", "", "number of the touchdown, from 1", &StepRow::number},
    StepColumn{"time", "s", "of the touchdown", &StepRow::time},
    StepColumn{"step_time", "s", "since the touchdown before, of any foot", &StepRow::step_time},
    StepColumn{"flight_time", "s", "of the foot, without force", &StepRow::flight_time},
    StepColumn{"extension", "s", "delay of the landing by the planner's swing-time rule",
               &StepRow::extension},
    StepColumn{"early", "s",
               "touchdown before the time that the planner counted on, extension included",
               &StepRow::early},
    StepColumn{"speed", "m/s", "of the foot, horizontal, in the last tick before contact",
               &StepRow::speed},
    StepColumn{"sink_speed", "m/s", "likewise, downward", &StepRow::sink_speed},
    StepColumn{"error", "m", "foot from the planner's last target, horizontal", &StepRow::error},
    StepColumn{"not_reached", "m", "of it: the foot's reference from the target",
               &StepRow::not_reached},
    StepColumn{"tracking", "m", "of it: the foot from its reference", &StepRow::tracking},
    StepColumn{"width", "m",
               "between the feet, across the heading; negative: crossed (robots with two feet)",
               &StepRow::width},
    StepColumn{"lateral_speed", "m/s", "of the CoM towards the landing foot, across the heading",
               &StepRow::lateral_speed},
    StepColumn{"lateral_predicted", "m/s", "likewise, as the planner predicted it",
               &StepRow::lateral_predicted},
    StepColumn{"friction", "",
               "largest tangential over normal force on one foot alone, since the touchdown before",
               &StepRow::friction},
    StepColumn{"slip_single", "m", "path of the loaded foot over the ground, on one foot",
               &StepRow::slip_single},
    StepColumn{"slip_double", "m", "likewise, all feet, while more than one is down",
               &StepRow::slip_double},
    StepColumn{"yaw", "rad", "heading of the base before contact", &StepRow::yaw},
    StepColumn{"yaw_rate", "rad/s", "about the vertical, before contact", &StepRow::yaw_rate},
    StepColumn{"yaw_rate_after", "rad/s", "likewise, when the other foot leaves the ground",
               &StepRow::yaw_rate_after},
    StepColumn{"tilt", "rad", "largest error of roll and pitch together since the touchdown before",
               &StepRow::tilt},
    StepColumn{"saturated", "ticks", "with a joint's torque at its limit, likewise",
               &StepRow::saturated},
    StepColumn{"clearance", "m", "largest height of the foot above where it left the ground",
               &StepRow::clearance},
};

}  // namespace

std::string StepColumn::header() const {
  std::string out(name);
  if (unit.empty()) return out;
  out += "_" + std::string(unit);
  std::ranges::replace(out, '/', '_');
  return out;
}

std::span<const StepColumn> step_columns() { return kStepColumns; }

std::string steps_csv(const std::vector<StepRow>& rows, const std::vector<std::string>& feet) {
  std::string out;
  for (const StepColumn& column : kStepColumns) {
    out += (out.empty() ? "" : ",") + column.header();
    if (column.value == &StepRow::number) out += ",foot";
  }
  out += "\n";
  for (const StepRow& row : rows) {
    std::string line;
    for (const StepColumn& column : kStepColumns) {
      if (!line.empty()) line += ",";
      const double value = row.*column.value;
      if (std::isfinite(value)) line += fmt::format("{:.6g}", value);
      if (column.value == &StepRow::number) {
        line += "," + feet.at(static_cast<std::size_t>(row.foot));
      }
    }
    out += line + "\n";
  }
  return out;
}

}  // namespace footfall::lab
