// Model of `footfall tune`; see model.h.
#include "apps/tune/model/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/diagnostics/did_you_mean.h"
#include "core/diagnostics/quantity_hint.h"
#include "core/index.h"
#include "core/text/printable.h"
#include "core/yaml/glob.h"

namespace footfall::apps {
namespace {

constexpr std::size_t kHistoryRows = 6000;  // 2 min at 50 Hz
constexpr std::size_t kNotes = 1000;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

double element(const std::vector<double>& values, int slot) {
  return slot >= 0 && at(slot) < values.size() ? values[at(slot)] : kNoValue;
}

std::span<const double> part(const std::vector<double>& values, const TuneParameter& parameter) {
  const std::size_t end = at(parameter.first) + extent(parameter.size);
  if (end > values.size()) return {};
  return std::span(values).subspan(at(parameter.first), extent(parameter.size));
}

double largest(std::span<const double> values) {
  double size = 0.0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

TuneParameter parameter_of(const footfall_lcm::parameter_t& told,
                           const std::vector<double>& of_file) {
  TuneParameter parameter;
  parameter.name = core::on_one_line(told.name);
  parameter.doc = core::on_one_line(told.doc);
  parameter.first = told.first;
  parameter.size = told.size;
  parameter.gain = told.gain != 0;
  if (std::ssize(told.axes) == told.size) {
    for (const std::string& axis : told.axes) parameter.axes.push_back(core::on_one_line(axis));
  }
  if (const auto unit = core::parse_unit(told.unit)) parameter.dimension = unit->dimension;
  if (told.has_range != 0) {
    parameter.min = told.min;
    parameter.max = told.max;
  }
  double size = largest(part(of_file, parameter));
  if (size == 0.0) size = std::max(std::abs(parameter.min), std::abs(parameter.max));
  parameter.unit = display_unit(parameter.dimension, size);
  return parameter;
}

// Parameters have their own axes, gains those of their task: not always x, y, z.
std::string component_name(const TuneParameter& parameter, int component) {
  constexpr int kAxes = 3;
  if (parameter.size == 1) return parameter.name;
  if (!parameter.axes.empty()) {
    return fmt::format("{}.{}", parameter.name, parameter.axes[at(component)]);
  }
  if (parameter.gain || parameter.size > kAxes) {
    return fmt::format("{}[{}]", parameter.name, component);
  }
  return fmt::format("{}.{}", parameter.name, static_cast<char>('x' + component));
}

double step_of(const TuneParameter& parameter, double of_file) {
  constexpr double kFirstGain = 1.0, kFirstOther = 0.1;  // SI, for values that are 0 in the file
  return default_step(of_file, parameter.min, parameter.max,
                      parameter.gain ? kFirstGain : kFirstOther, parameter.unit);
}

void list_entries(TuneModel& model) {
  model.entries.clear();
  for (int p = 0; p < static_cast<int>(model.parameters.size()); ++p) {
    const TuneParameter& parameter = model.parameters[at(p)];
    for (int c = 0; c < parameter.size; ++c) {
      const int slot = parameter.first + c;
      model.entries.push_back({component_name(parameter, c), p, parameter.size == 1 ? -1 : c, slot,
                               step_of(parameter, element(model.catalogue.values, slot))});
    }
  }
}

// The component that a name's last part means, `x`, `pitch` or `1]`; -1 if none, the size or more
// if there are fewer values.
int component_of(const TuneParameter& parameter, std::string_view last) {
  if (last.ends_with(']')) {
    int component = -1;
    const char* const end = last.data() + last.size() - 1;
    const auto [stop, error] = std::from_chars(last.data(), end, component);
    return error == std::errc() && stop == end ? component : -1;
  }
  const auto named = std::ranges::find(parameter.axes, last);
  if (named != parameter.axes.end()) return static_cast<int>(named - parameter.axes.begin());
  const bool letter =
      parameter.axes.empty() && last.size() == 1 && last[0] >= 'x' && last[0] <= 'z';
  return letter ? last[0] - 'x' : -1;
}

std::vector<std::string> names_of(const TuneModel& model) {
  std::vector<std::string> names;
  for (const TuneParameter& parameter : model.parameters) names.push_back(parameter.name);
  return names;
}

// Why a name cannot be changed: it is unknown, or not live.
std::string unknown_parameter(const TuneModel& model, std::string_view name) {
  const auto& fixed = model.catalogue.fixed;
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    const bool part = name.starts_with(fixed[k]) && name.size() > fixed[k].size() &&
                      (name[fixed[k].size()] == '.' || name[fixed[k].size()] == '[');
    if ((name != fixed[k] && !part) || k >= model.catalogue.fixed_reasons.size()) continue;
    return fmt::format("'{}' is not live, because {}", name,
                       core::on_one_line(model.catalogue.fixed_reasons[k]));
  }
  std::vector<std::string> names = names_of(model);
  for (const TuneEntry& entry : model.entries) names.push_back(entry.name);
  names.insert(names.end(), fixed.begin(), fixed.end());
  return fmt::format("unknown parameter '{}'{}", name, core::did_you_mean(name, names));
}

const TuneParameter* find_exactly(const TuneModel& model, std::string_view name) {
  const auto found = std::ranges::find(model.parameters, name, &TuneParameter::name);
  return found == model.parameters.end() ? nullptr : &*found;
}

footfall_lcm::change_t change(std::string name, int component, std::vector<double> values) {
  footfall_lcm::change_t change;
  change.name = std::move(name);
  change.component = component;
  change.count = static_cast<std::int32_t>(values.size());
  change.values = std::move(values);
  return change;
}

// Parses one text; reports a problem as one line of text.
footfall_lcm::change_t read_change(const TuneModel& model, std::string_view text,
                                   std::string& problem) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string_view::npos) {
    problem = fmt::format("expected NAME=VALUE, got '{}'", text);
    return {};
  }
  const std::string_view written = text.substr(0, equals);
  int component = -1;
  const TuneParameter* parameter = find_exactly(model, written);
  const std::size_t last = written.find_last_of(written.ends_with(']') ? '[' : '.');
  if (parameter == nullptr && last != std::string_view::npos) {
    parameter = find_exactly(model, written.substr(0, last));
    if (parameter != nullptr) component = component_of(*parameter, written.substr(last + 1));
    if (component < 0) parameter = nullptr;
  }
  if (parameter == nullptr) {
    problem = unknown_parameter(model, written);
    return {};
  }
  if (component >= parameter->size) {
    problem = fmt::format("{}: it has {} value{}", written, parameter->size,
                          parameter->size == 1 ? "" : "s");
    return {};
  }
  ReadValues read = read_values(text.substr(equals + 1), parameter->dimension,
                                component < 0 ? parameter->size : 1, parameter->gain);
  if (!read.problem.empty()) problem = fmt::format("{}: {}", written, read.problem);
  if (read.values.size() == 1 && !problem.empty()) {
    problem += fmt::format(": {}={} sets one, \"{}=[...]\" all", component_name(*parameter, 0),
                           text.substr(equals + 1), written);
  }
  return change(parameter->name, component, std::move(read.values));
}

}  // namespace

double TuneModel::value_now(int slot) const { return element(values.now, slot); }
double TuneModel::value_in_telemetry(int slot) const {
  const bool same = values.tick == telemetry.tick;
  const bool at_rest = values.tick < telemetry.tick && value_now(slot) == value_target(slot);
  const bool known = values.revision == telemetry.revision && (same || at_rest);
  return known ? value_now(slot) : kNoValue;
}
double TuneModel::value_target(int slot) const { return element(values.target, slot); }
double TuneModel::value_of_file(int slot) const { return element(file_values, slot); }

void take_catalogue(TuneModel& model, const footfall_lcm::catalogue_t& catalogue) {
  const auto& known = model.catalogue;
  if (catalogue.session == known.session && catalogue.generation == known.generation) return;
  model.catalogue = catalogue;
  model.parameters.clear();
  for (const footfall_lcm::parameter_t& told : catalogue.parameters) {
    // Data from the network may be inconsistent.
    const bool whole = told.first >= 0 && told.size > 0 &&
                       std::int64_t{told.first} + told.size <= std::ssize(catalogue.values);
    if (whole) model.parameters.push_back(parameter_of(told, catalogue.values));
  }
  std::ranges::sort(model.parameters, [](const TuneParameter& a, const TuneParameter& b) {
    return a.gain != b.gain ? b.gain : a.name < b.name;
  });
  list_entries(model);
  model.file_values = catalogue.values;
  model.values = {};
  model.values.now = model.values.target = catalogue.values;
  model.values.revision = catalogue.revision;
  model.telemetry_heard = false;
  model.history.reset(catalogue.signals.size(), kHistoryRows);
}

void take_values(TuneModel& model, const footfall_lcm::values_t& values) {
  const std::size_t size = model.catalogue.values.size();
  const bool ours =
      values.session == model.catalogue.session && values.generation == model.catalogue.generation;
  if (ours && values.now.size() == size && values.target.size() == size) model.values = values;
}

void take_telemetry(TuneModel& model, const footfall_lcm::telemetry_t& telemetry) {
  if (telemetry.session != model.catalogue.session ||
      telemetry.generation != model.catalogue.generation) {
    return;
  }
  model.telemetry = telemetry;
  model.telemetry_heard = true;
  model.history.add(telemetry.time, telemetry.signals);
}

void take_answer(TuneModel& model, const footfall_lcm::answer_t& answer, std::int64_t client) {
  if (answer.session != model.catalogue.session) return;
  TuneNote note;
  const bool applied = answer.tick >= 0 && model.catalogue.rate > 0.0;
  note.time =
      applied ? static_cast<double>(answer.tick) / model.catalogue.rate : model.telemetry.time;
  note.who = answer.who;
  note.accepted = answer.accepted != 0;
  note.own = answer.client == client;
  note.text = answer.text;
  if (!note.accepted) {
    if (!note.text.empty()) note.text += ": ";
    note.text += fmt::format("refused: {}", fmt::join(answer.reasons, "; "));
  }
  model.notes.push_back(std::move(note));
  if (model.notes.size() > kNotes) model.notes.pop_front();
}

void take_file_values(TuneModel& model, std::vector<double> values) {
  if (values.size() == model.file_values.size()) model.file_values = std::move(values);
}

std::span<const double> now_of(const TuneModel& model, const TuneParameter& parameter) {
  return part(model.values.now, parameter);
}
std::span<const double> target_of(const TuneModel& model, const TuneParameter& parameter) {
  return part(model.values.target, parameter);
}
std::span<const double> file_of(const TuneModel& model, const TuneParameter& parameter) {
  return part(model.file_values, parameter);
}

bool differs_from_file(const TuneModel& model, const TuneParameter& parameter) {
  return !std::ranges::equal(target_of(model, parameter), file_of(model, parameter));
}

std::string range_text(const TuneParameter& parameter) {
  if (!parameter.has_range()) return {};
  return fmt::format("{} to {}", shown_value(parameter.min, {{}, parameter.unit.factor}),
                     shown_value(parameter.max, parameter.unit));
}

bool passes_filter(std::string_view name, std::string_view filter) {
  return core::is_glob(filter) ? core::glob_matches(filter, name)
                               : name.find(filter) != std::string_view::npos;
}

std::vector<int> find_parameters(const TuneModel& model, std::string_view name,
                                 std::string& problem) {
  std::vector<int> found;
  for (int p = 0; p < static_cast<int>(model.parameters.size()); ++p) {
    const std::string& known = model.parameters[at(p)].name;
    if (core::is_glob(name) ? core::glob_matches(name, known) : name == known) found.push_back(p);
  }
  if (found.empty()) {
    problem = core::is_glob(name) ? fmt::format("no live parameter or gain matches '{}'", name)
                                  : unknown_parameter(model, name);
  }
  return found;
}

std::vector<footfall_lcm::change_t> read_changes(const TuneModel& model,
                                                 const std::vector<std::string>& texts,
                                                 std::vector<std::string>& problems) {
  std::vector<footfall_lcm::change_t> changes;
  for (std::size_t k = 0; k < texts.size(); ++k) {
    bool rest = false;
    const std::size_t equals = texts[k].find('=');
    const bool setting = equals != std::string::npos && equals > 0;
    const std::string hint = setting ? "" : core::split_argument_hint(texts, k, rest);
    if (rest) continue;
    std::string problem;
    changes.push_back(read_change(model, texts[k], problem));
    if (!problem.empty() && !hint.empty()) problem += ": " + hint;
    if (!problem.empty()) problems.push_back(std::move(problem));
  }
  return changes;
}

void check_events(const TuneModel& model, const std::vector<std::string>& events,
                  std::vector<std::string>& problems) {
  const std::vector<std::string>& known = model.catalogue.events;
  for (const std::string& event : events) {
    if (std::ranges::find(known, event) != known.end()) continue;
    problems.push_back(
        known.empty()
            ? fmt::format("unknown event '{}': this behavior takes none from outside", event)
            : fmt::format("unknown event '{}'{}", event, core::did_you_mean_or_list(event, known)));
  }
}

footfall_lcm::change_t change_of(const TuneModel& model, const TuneEntry& entry, double value) {
  return change(model.parameters[at(entry.parameter)].name, entry.component, {value});
}

std::vector<footfall_lcm::change_t> changes_to_file(const TuneModel& model) {
  std::vector<footfall_lcm::change_t> changes;
  for (const TuneParameter& parameter : model.parameters) {
    if (!differs_from_file(model, parameter)) continue;
    const auto values = file_of(model, parameter);
    changes.push_back(change(parameter.name, -1, {values.begin(), values.end()}));
  }
  return changes;
}

footfall_lcm::request_t edit_request(std::vector<footfall_lcm::change_t> changes,
                                     std::vector<std::string> events, double over,
                                     std::int64_t revision) {
  footfall_lcm::request_t request{};
  request.what = footfall_lcm::request_t::EDIT;
  request.over = over;
  request.revision = revision;
  request.change_count = static_cast<std::int32_t>(changes.size());
  request.changes = std::move(changes);
  request.event_count = static_cast<std::int32_t>(events.size());
  request.events = std::move(events);
  return request;
}

footfall_lcm::request_t undo_request(bool redo) {
  footfall_lcm::request_t request{};
  request.what = redo ? footfall_lcm::request_t::REDO : footfall_lcm::request_t::UNDO;
  request.revision = -1;
  return request;
}

bool is_conflict(const footfall_lcm::request_t& request, const footfall_lcm::answer_t& answer) {
  return answer.accepted == 0 && request.revision >= 0 && answer.revision != request.revision;
}

int find_signal(const TuneModel& model, std::string_view name) {
  const auto& names = model.catalogue.signals;
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

double signal_value(const TuneModel& model, std::string_view name) {
  const int index = find_signal(model, name);
  const auto& row = model.telemetry.signals;
  if (index < 0 || at(index) >= row.size() || !std::isfinite(row[at(index)])) return kNoValue;
  // The number in the float's shortest decimal text: 0.9, not 0.89999998.
  const auto quantity = core::parse_quantity(fmt::format("{}", row[at(index)]));
  return quantity ? quantity->value : kNoValue;
}

std::string signal_unit(const TuneModel& model, std::string_view name) {
  const int index = find_signal(model, name);
  const auto& units = model.catalogue.signal_units;
  return index >= 0 && at(index) < units.size() ? units[at(index)] : std::string();
}

}  // namespace footfall::apps
