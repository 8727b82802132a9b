// Figures from the rows of a log; see log_figures.h.
#include "lab/figures/log_figures.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/text/json_text.h"

namespace footfall::lab {
namespace {

using nlohmann::json;

// Ticks until the next row, for a row stands for them, too. A gap in the log counts as one row.
std::int64_t ticks_of(const Log& log, std::size_t row) {
  if (log.tick.size() != log.rows() || row + 1 >= log.rows()) return 1;
  return std::clamp<std::int64_t>(log.tick[row + 1] - log.tick[row], 1, log.row_every);
}

// Time at which the behavior's control ended, s; none while it goes on.
std::optional<double> let_go_at(const Log& log) {
  for (const LoggedEvent& event : log.events) {
    const bool by_itself =
        event.name == "fall" || event.name == "fault" || event.name == "finished";
    if (event.kind == "end" && by_itself) return event.time;
  }
  return {};
}

}  // namespace

SampleNames sample_names(const Log& log) {
  SampleNames names;
  names.contacts = parts(log, "contact.", "");
  names.joints = parts(log, "joint.", ".command");
  names.internals = parts(log, "internal.", ".reference");
  json types = core::parse_json(log.get("tasks"));
  if (!types.is_object()) types = json::object();
  for (const auto& [task, type] : types.items()) {
    if (type == "com_position") names.height_tasks.push_back(task);
    if (type == "body_orientation") names.orientation_tasks.push_back(task);
  }
  const std::vector<std::string> planners = parts(log, "planner.", ".target.x");
  if (!planners.empty()) names.planner = planners.front();
  names.odometry = has_own_frame(log.get("estimator"));
  return names;
}

RunFigures log_figures(const Log& log) {
  const SampleNames names = sample_names(log);
  const SampleColumns columns =
      sample_columns(names, [&](std::string_view n) { return log.find(n); });
  const std::optional<double> counted_from =
      log.part && log.rows() > 0 ? std::optional(log.time.front()) : std::nullopt;
  const double period = 1e3 / static_cast<double>(log.rate_mhz);
  RunMetrics metrics(names, period, counted_from);
  const std::optional<double> end = let_go_at(log);
  for (std::size_t row = 0; row < log.rows(); ++row) {
    TickSample tick =
        read_sample(columns, [&](int i) { return log.column[static_cast<std::size_t>(i)][row]; });
    tick.time = log.time[row];
    tick.ticks = ticks_of(log, row);
    // The end is told at the time after the last tick.
    tick.going_on = !end || log.time[row] + 1.5 * period < *end;
    metrics.observe(tick);
  }
  const double length =
      log.rows() == 0 ? 0.0 : log.time.back() + period - (log.part ? log.time.front() : 0.0);
  return metrics.figures(length, false);
}

}  // namespace footfall::lab
