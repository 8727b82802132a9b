// Implementation of `footfall trace`; see trace.h.
#include "behaviors/statechart/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "behaviors/statechart/statechart.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/value_reader.h"

namespace footfall::behaviors {
namespace {

constexpr auto kEnginesOwn = std::to_array<std::string_view>(
    {"contact.", "planner.", "fault.", "done.", "error.", "parameter.changed."});

std::string json_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

void write_line(const Behavior& behavior, const Statechart& statechart, const std::string* event,
                std::ostream& out) {
  out << "{\"event\":" << (event == nullptr ? "null" : json_text(*event)) << ",\"active\":[";
  const char* comma = "";
  for (const int s : statechart.active_atomic()) {
    out << comma << json_text(behavior.states[static_cast<std::size_t>(s)].name);
    comma = ",";
  }
  out << "]}\n";
}

std::optional<TraceStep> read_step(const core::YamlNode& node, core::Diagnostics& diagnostics) {
  if (!core::expect_map(node, "{after: TIME} or {event: NAME}", diagnostics)) return std::nullopt;
  core::check_keys(node, {"after", "event"}, diagnostics);
  const core::YamlNode* after = node.find("after");
  const core::YamlNode* event = node.find("event");
  if ((after == nullptr) == (event == nullptr)) {
    diagnostics.error(node.mark, "expected", "expected either `after` or `event`");
    return std::nullopt;
  }
  if (event != nullptr) {
    const auto name = core::read_text(*event, diagnostics, "the name of an event");
    if (!name) return std::nullopt;
    return TraceStep{-1.0, *name};
  }
  const auto time = core::read_bounded(*after, core::kTime, 0.0, 1e5, diagnostics);
  if (!time) return std::nullopt;
  return TraceStep{*time, {}};
}

std::optional<std::vector<TraceStep>> read_script(const core::YamlNode& root,
                                                  core::Diagnostics& diagnostics) {
  if (root.is_null()) return std::nullopt;
  if (!core::expect_sequence(root, "a list of {after: TIME} and {event: NAME}", diagnostics)) {
    return std::nullopt;
  }
  std::vector<TraceStep> steps;
  bool good = true;
  for (const core::YamlNode& item : root.items) {
    const auto step = read_step(item, diagnostics);
    good = good && step.has_value();
    if (step) steps.push_back(*step);
  }
  if (!good) return std::nullopt;
  // Only an event prints a line; but what a last delay leads to would not be seen at all.
  if (!steps.empty() && steps.back().after >= 0.0) steps.back().shown = true;
  return steps;
}

int index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

// A script may raise events that the behavior does not name; prefixes and `*` match these, too.
Chart with_events_of(const Behavior& behavior, const std::vector<TraceStep>& steps) {
  Chart chart = behavior;
  for (const TraceStep& step : steps) {
    if (step.after < 0.0 && index_of(chart.events, step.event) < 0) {
      chart.events.push_back(step.event);
    }
  }
  chart.match_events();
  if (!chart.script_events.empty()) chart.script_events.resize(chart.events.size());
  return chart;
}

}  // namespace

std::optional<std::vector<TraceStep>> load_trace_script(const std::string& path,
                                                        core::Diagnostics& diagnostics) {
  return read_script(core::load_yaml_file(path, diagnostics), diagnostics);
}

std::optional<std::vector<TraceStep>> load_trace_script_text(std::string_view text,
                                                             const std::string& name,
                                                             core::Diagnostics& diagnostics) {
  return read_script(core::load_yaml_text(text, name, diagnostics), diagnostics);
}

std::vector<TraceStep> trace_events(std::string_view names) {
  std::vector<TraceStep> steps;
  while (!names.empty()) {
    const std::size_t comma = std::min(names.find(','), names.size());
    std::string name(names.substr(0, comma));
    name.erase(0, name.find_first_not_of(' '));
    name.erase(name.find_last_not_of(' ') + 1);
    if (!name.empty()) steps.push_back({-1.0, name});
    names.remove_prefix(std::min(comma + 1, names.size()));
  }
  return steps;
}

std::vector<std::string> unknown_events(const Behavior& behavior,
                                        const std::vector<TraceStep>& steps) {
  std::vector<std::string> sentences;
  if (!behavior.scripts.empty()) return sentences;  // scripts may raise any event
  std::vector<std::string> seen = behavior.events;
  for (const TraceStep& step : steps) {
    if (step.after >= 0.0 || index_of(seen, step.event) >= 0) continue;
    seen.push_back(step.event);
    const bool built_in =
        std::ranges::any_of(kEnginesOwn, [&](auto own) { return step.event.starts_with(own); });
    const bool heard = std::ranges::any_of(behavior.patterns, [&](const EventPattern& pattern) {
      return Chart::event_matches(pattern.text, step.event);
    });
    if (built_in || heard) continue;
    sentences.push_back(
        fmt::format("nothing listens to the event '{}', and `events` does not list it{}",
                    step.event, core::did_you_mean(step.event, behavior.events)));
  }
  return sentences;
}

void trace(const Behavior& behavior, const std::vector<TraceStep>& steps, std::ostream& out) {
  const Chart chart = with_events_of(behavior, steps);
  core::SignalTable signals = behavior.signals;
  std::vector<double> values = behavior.values;
  Statechart statechart(chart, signals.values(), values);
  std::int64_t tick = 0;
  double seconds = 0.0;  // delays add up before rounding up to whole periods
  const auto run = [&](int event) {
    statechart.begin_tick(tick);
    if (behavior.layout.time >= 0) {
      signals[behavior.layout.time] = static_cast<double>(tick) * behavior.period();
    }
    statechart.raise(event);
    statechart.run();
  };
  statechart.start(tick);
  run(-1);
  write_line(behavior, statechart, nullptr, out);
  for (const TraceStep& step : steps) {
    if (step.after < 0.0) {
      run(index_of(chart.events, step.event));
      write_line(behavior, statechart, &step.event, out);
      continue;
    }
    seconds += step.after;
    const std::int64_t end = periods_of(seconds, behavior.rate_mhz);
    while (tick < end) {
      ++tick;
      run(-1);
    }
    if (step.shown) write_line(behavior, statechart, nullptr, out);
  }
}

}  // namespace footfall::behaviors
