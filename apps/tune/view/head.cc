// Status of the robot in a few lines; see head.h.
#include "apps/tune/view/head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/units/units.h"

namespace footfall::apps {
namespace {

using footfall_lcm::telemetry_t;

constexpr double kFullAuthority = 0.995;  // from here on displayed as 100 %

// Falls back to the number if there is no name.
std::string name_of(const std::vector<std::string>& names, std::int32_t index) {
  return index >= 0 && at(index) < names.size() ? names[at(index)] : fmt::format("#{}", index);
}

StyledLine labelled(const char* label) { return {{fitted(label, 8), Style::dim}}; }

// Adds `text` at the right edge if there is room.
void put_right(StyledLine& line, Span span, int width) {
  int used = 0;
  for (const Span& each : line) used += text_columns(each.text);
  const int left = width - used - text_columns(span.text) - 1;
  if (left < 1) return;
  line.push_back({std::string(at(left), ' '), line.empty() ? Style::plain : line.back().style});
  line.push_back(std::move(span));
}

StyledLine title_line(const TuneModel& model, double silence, int width) {
  const auto& told = model.catalogue;
  StyledLine line = {{fmt::format(" {} on {}", told.behavior, told.robot), Style::title}};
  std::string right = fmt::format("revision {}", model.values.revision);
  if (model.telemetry_heard) {
    right = fmt::format("{:.1f} s  {}  {}", model.telemetry.time, condition_text(model), right);
  }
  if (silence > kLongSilence) right = fmt::format("no word for {:.0f} s", silence);
  put_right(line, {right, silence > kLongSilence ? Style::bad : Style::title}, width);
  return line;
}

StyledLine state_line(const TuneModel& model, int width) {
  StyledLine line = labelled(" state");
  line.push_back({states_text(model), Style::strong});
  const double steps = signal_value(model, "steps");
  if (std::isfinite(steps)) put_right(line, {fmt::format("step {:.0f}", steps)}, width);
  return line;
}

StyledLine feet_line(const TuneModel& model, int width) {
  StyledLine line = labelled(" feet");
  const auto& told = model.telemetry;
  for (std::size_t i = 0; i < told.forces.size(); ++i) {
    constexpr std::size_t kUp = 2;
    if (told.forces[i].size() <= kUp) continue;
    const double force = told.forces[i][kUp];
    const std::string number = fmt::format("{:.0f} N", std::abs(force) < 0.5 ? 0.0 : force);
    line.push_back({name_of(model.catalogue.feet, static_cast<std::int32_t>(i)) +
                    fitted_right(number, 7) + "   "});
  }
  if (model.telemetry_heard) {
    put_right(line,
              {fmt::format("tick {:.0f} us, worst {:.0f} us", told.tick_us, told.tick_us_worst)},
              width);
  }
  return line;
}

std::string task_error(const TuneModel& model, const std::string& task, double error) {
  const auto unit = core::parse_unit(signal_unit(model, fmt::format("task.{}.error", task)));
  if (unit && unit->dimension == core::kLength) return fmt::format("{:.1f} mm", 1e3 * error);
  return unit ? shown_value(error, display_unit(unit->dimension, error), 2)
              : fmt::format("{:.3f}", error);
}

StyledLine tasks_line(const TuneModel& model) {
  StyledLine line = labelled(" tasks");
  for (const auto& told : model.telemetry.tasks) {
    const std::string name = name_of(model.catalogue.tasks, told.name);
    line.push_back({fmt::format("{} {}", name, task_error(model, name, told.error))});
    if (told.authority < kFullAuthority) {
      line.push_back({fmt::format(" ({:.0f} % left)", 100.0 * told.authority), Style::warning});
    }
    line.push_back({"   "});
  }
  return line;
}

StyledLine faults_line(const TuneModel& model, int width) {
  StyledLine line = labelled(" faults");
  bool any = false;
  for (std::size_t i = 0; i < model.telemetry.faults.size(); ++i) {
    if (model.telemetry.faults[i] == 0) continue;
    any = true;
    line.push_back(
        {fmt::format("{} {}   ", name_of(model.catalogue.faults, static_cast<std::int32_t>(i)),
                     model.telemetry.faults[i]),
         Style::bad});
  }
  if (!any) line.push_back({model.telemetry_heard ? "none" : "", Style::good});
  const std::string undo =
      fmt::format("undo {}, redo {}", model.values.undo_count, model.values.redo_count);
  put_right(line, {undo, Style::dim}, width);
  return line;
}

}  // namespace

std::string condition_text(const TuneModel& model) {
  if (!model.telemetry_heard) return {};
  switch (model.telemetry.condition) {
    case telemetry_t::RUNNING:
      return "running";
    case telemetry_t::FINISHED:
      return "finished";
    case telemetry_t::FALLEN:
      return "fallen";
    case telemetry_t::ENDED:
      return "ended";
    default:
      return "stopped";
  }
}

std::string states_text(const TuneModel& model) {
  std::string text;
  for (const std::int32_t state : model.telemetry.active) {
    text += (text.empty() ? "" : "  ") + name_of(model.catalogue.states, state);
  }
  return text;
}

std::vector<StyledLine> head_lines(const TuneModel& model, double silence, int width) {
  return {title_line(model, silence, width), state_line(model, width), feet_line(model, width),
          tasks_line(model), faults_line(model, width)};
}

}  // namespace footfall::apps
