// Output of the sub-commands of `footfall tune`; see tables.h.
#include "apps/tune/view/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/tune/view/head.h"
#include "apps/tune/view/picture.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/index.h"
#include "core/text/printable.h"
#include "core/yaml/glob.h"

namespace footfall::apps {
namespace {

using nlohmann::ordered_json;

// A table with columns as wide as their longest cell, separated by two blanks; empty columns and
// trailing blanks are omitted.
std::string table_text(const std::vector<std::vector<std::string>>& rows) {
  std::vector<int> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t k = 0; k < row.size(); ++k) {
      widths[k] = std::max(widths[k], text_columns(row[k]));
    }
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (widths[k] > 0) text += fitted(row[k], widths[k]) + "  ";
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

const TuneParameter& parameter_at(const TuneModel& model, int index) {
  return model.parameters[at(index)];
}

std::string value_cell(const TuneModel& model, const TuneParameter& parameter) {
  std::string text = shown_values(now_of(model, parameter), parameter.unit);
  if (!std::ranges::equal(now_of(model, parameter), target_of(model, parameter))) {
    text += " -> " + shown_values(target_of(model, parameter), parameter.unit);
  }
  return text;
}

ordered_json one_or_list(std::span<const double> values) {
  if (values.size() == 1) return values[0];
  return ordered_json(std::vector<double>(values.begin(), values.end()));
}

ordered_json parameter_json(const TuneModel& model, const TuneParameter& parameter) {
  const bool range = parameter.has_range();
  return {{"name", parameter.name},
          {"value", one_or_list(now_of(model, parameter))},
          {"target", one_or_list(target_of(model, parameter))},
          {"file", one_or_list(file_of(model, parameter))},
          {"unit", core::unit_text(parameter.dimension)},
          {"min", range ? ordered_json(parameter.min) : ordered_json()},
          {"max", range ? ordered_json(parameter.max) : ordered_json()},
          {"gain", parameter.gain},
          {"doc", parameter.doc}};
}

double column_value(const TuneModel& model, const WatchColumn& column) {
  return column.slot >= 0 ? model.value_in_telemetry(column.slot)
                          : signal_value(model, column.name);
}

void add_column(const TuneModel& model, std::vector<WatchColumn>& columns, WatchColumn column) {
  constexpr int kLeast = 10;
  if (column.slot < 0) {
    const auto unit = core::parse_unit(signal_unit(model, column.name));
    column.unit = unit ? core::unit_text(unit->dimension) : std::string();
  }
  const std::string head = column.name + (column.unit.empty() ? "" : " (" + column.unit + ")");
  column.width = std::max(kLeast, text_columns(head));
  columns.push_back(std::move(column));
}

std::string head_of(const WatchColumn& column) {
  return column.name + (column.unit.empty() ? "" : " (" + column.unit + ")");
}

}  // namespace

std::string list_text(const TuneModel& model, const std::vector<int>& parameters) {
  std::vector<std::vector<std::string>> rows;
  for (const int index : parameters) {
    const TuneParameter& parameter = parameter_at(model, index);
    const bool differs = differs_from_file(model, parameter);
    const std::string range = range_text(parameter);
    rows.push_back(
        {parameter.name, value_cell(model, parameter),
         differs ? "file " + shown_values(file_of(model, parameter), parameter.unit) : "",
         range.empty() ? "" : "range " + range, parameter.doc});
  }
  return table_text(rows);
}

std::string get_text(const TuneModel& model, const std::vector<int>& parameters) {
  std::string text;
  for (const int index : parameters) {
    const TuneParameter& parameter = parameter_at(model, index);
    text += fmt::format("{}={}\n", parameter.name,
                        exact_values(target_of(model, parameter), parameter.unit));
  }
  return text;
}

std::string difference_text(const TuneModel& model, const std::vector<int>& parameters) {
  std::vector<std::vector<std::string>> rows;
  for (const int index : parameters) {
    const TuneParameter& parameter = parameter_at(model, index);
    if (!differs_from_file(model, parameter)) continue;
    rows.push_back({parameter.name, exact_values(file_of(model, parameter), parameter.unit),
                    "-> " + exact_values(target_of(model, parameter), parameter.unit)});
  }
  return table_text(rows);
}

std::string names_text(const TuneModel& model, const std::vector<int>& parameters) {
  std::string text;
  for (const int index : parameters) text += parameter_at(model, index).name + "\n";
  return text;
}

ordered_json list_json(const TuneModel& model, const std::vector<int>& parameters) {
  ordered_json list = ordered_json::array();
  for (const int index : parameters) {
    list.push_back(parameter_json(model, parameter_at(model, index)));
  }
  return {{"behavior", model.catalogue.behavior},
          {"path", model.catalogue.path},
          {"robot", model.catalogue.robot},
          {"revision", model.values.revision},
          {"parameters", std::move(list)}};
}

std::string answer_text(const footfall_lcm::answer_t& answer) {
  return fmt::format("accepted at tick {}, revision {}: {}", answer.tick, answer.revision,
                     core::on_one_line(answer.text));
}

ordered_json answer_json(const footfall_lcm::answer_t& answer) {
  return {{"accepted", answer.accepted != 0},
          {"tick", answer.tick},
          {"revision", answer.revision},
          {"text", answer.text},
          {"reasons", answer.reasons}};
}

std::vector<WatchColumn> watch_columns(const TuneModel& model,
                                       const std::vector<std::string>& names,
                                       std::vector<std::string>& problems) {
  std::vector<WatchColumn> columns;
  std::vector<std::string> known = model.catalogue.signals;
  for (const TuneEntry& entry : model.entries) known.push_back(entry.name);
  for (const std::string& name : names) {
    const auto wanted = [&](const std::string& candidate) {
      return core::is_glob(name) ? core::glob_matches(name, candidate) : name == candidate;
    };
    const std::size_t before = columns.size();
    for (int s = 0; s < static_cast<int>(model.catalogue.signals.size()); ++s) {
      const std::string& signal = model.catalogue.signals[at(s)];
      if (wanted(signal)) add_column(model, columns, {signal, {}, s, -1, 0});
    }
    for (const TuneEntry& entry : model.entries) {
      const TuneParameter& parameter = parameter_at(model, entry.parameter);
      if (!wanted(entry.name) && !wanted(parameter.name)) continue;
      // Parameters of a goal are signals, too.
      if (find_signal(model, entry.name) >= 0 && wanted(entry.name)) continue;
      add_column(model, columns,
                 {entry.name, core::unit_text(parameter.dimension), -1, entry.slot, 0});
    }
    if (columns.size() > before) continue;
    problems.push_back(fmt::format("no signal, live parameter or gain '{}'{}", name,
                                   core::did_you_mean(name, known)));
  }
  return columns;
}

std::string watch_head(const std::vector<WatchColumn>& columns) {
  std::string text = fitted_right("time (s)", 10);
  for (const WatchColumn& column : columns)
    text += "  " + fitted_right(head_of(column), column.width);
  return text + "  state\n";
}

std::string watch_line(const TuneModel& model, const std::vector<WatchColumn>& columns) {
  std::string text = fitted_right(fmt::format("{:.3f}", model.telemetry.time), 10);
  for (const WatchColumn& column : columns) {
    const double value = column_value(model, column);
    text += "  " +
            fitted_right(std::isfinite(value) ? fmt::format("{:.6g}", value) : "-", column.width);
  }
  return text + "  " + core::on_one_line(states_text(model)) + "\n";
}

ordered_json watch_json(const TuneModel& model, const std::vector<WatchColumn>& columns) {
  ordered_json line = {{"time_s", model.telemetry.time}, {"tick", model.telemetry.tick}};
  ordered_json& states = line["states"] = ordered_json::array();
  for (const std::int32_t state : model.telemetry.active) {
    if (state >= 0 && at(state) < model.catalogue.states.size()) {
      states.push_back(model.catalogue.states[at(state)]);
    }
  }
  for (const WatchColumn& column : columns) {
    const double value = column_value(model, column);
    line[column.name] = std::isfinite(value) ? ordered_json(value) : ordered_json();
  }
  return line;
}

std::string note_line(const TuneNote& note) {
  return fmt::format("{:10.3f}  {}: {}\n", note.time, core::on_one_line(note.who),
                     core::on_one_line(note.text));
}

ordered_json note_json(const TuneNote& note) {
  return {
      {"time_s", note.time}, {"who", note.who}, {"accepted", note.accepted}, {"edit", note.text}};
}

}  // namespace footfall::apps
