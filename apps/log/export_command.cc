// `footfall export`: a log as CSV, for other programs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/log_argument.h"
#include "apps/shared/output_option.h"
#include "apps/shared/time_option.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/json_text.h"
#include "core/text/whole_file.h"
#include "core/units/units.h"
#include "core/yaml/glob.h"
#include "lab/steps/log_steps.h"
#include "lab/steps/step_columns.h"

namespace footfall::apps {
namespace {

struct ExportArguments {
  std::string log, out, from, to;
  std::vector<std::string> signals;
  bool csv = false, events = false, steps = false, all = false;
};

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

constexpr std::string_view kState = "state";
constexpr std::string_view kTimeSignal = "time";  // a column of its own, exactly

// Selected columns in log order; a pattern without match is an error.
std::vector<std::size_t> chosen(const ExportArguments& arguments, const lab::Log& log) {
  std::vector<bool> wanted(log.signals.size(), arguments.signals.empty());
  for (const std::string& pattern : arguments.signals) {
    bool any = false;
    for (std::size_t s = 0; s < log.signals.size(); ++s) {
      if (!core::glob_matches(pattern, log.signals[s].name)) continue;
      wanted[s] = any = true;
    }
    if (any) continue;
    std::vector<std::string> names;
    for (const auto& signal : log.signals) names.push_back(signal.name);
    throw std::runtime_error(fmt::format("--signals: error: no signal '{}' in the log{}", pattern,
                                         core::did_you_mean(pattern, names)));
  }
  std::vector<std::size_t> columns;
  for (std::size_t s = 0; s < wanted.size(); ++s) {
    if (wanted[s] && log.signals[s].name != kTimeSignal) columns.push_back(s);
  }
  return columns;
}

// By value of the signal `state`; empty for a log without them.
std::vector<std::string> state_paths(const lab::Log& log) {
  std::vector<std::string> paths;
  for (const auto& path : core::parse_json(log.get("states", "[]"))) paths.push_back(path);
  return paths;
}

std::string signals_csv(const ExportArguments& arguments, const lab::Log& log,
                        const TimeSpan& span) {
  const std::vector<std::size_t> columns = chosen(arguments, log);
  fmt::memory_buffer out;
  const std::vector<std::string> states = state_paths(log);
  // Names as `footfall signals` has them; values in SI units.
  fmt::format_to(std::back_inserter(out), "tick,time");
  for (const std::size_t s : columns) {
    fmt::format_to(std::back_inserter(out), ",{}", quoted(log.signals[s].name));
  }
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (log.time[row] < span.from || log.time[row] > span.to) continue;
    fmt::format_to(std::back_inserter(out), "\n{},{:.9f}", log.tick[row], log.time[row]);
    for (const std::size_t s : columns) {
      const float value = log.column[s][row];
      if (value != value) {
        out.push_back(',');  // no value: an empty field
      } else if (log.signals[s].name == kState && value >= 0.0F &&
                 static_cast<std::size_t>(value) < states.size()) {
        fmt::format_to(std::back_inserter(out), ",{}",
                       quoted(states[static_cast<std::size_t>(value)]));
      } else {
        fmt::format_to(std::back_inserter(out), ",{}", value);
      }
    }
  }
  out.push_back('\n');
  return fmt::to_string(out);
}

std::string events_csv(const lab::Log& log, const TimeSpan& span) {
  std::string out = "tick,time_s,kind,name,detail\n";
  for (const lab::LoggedEvent& e : log.events) {
    if (e.time < span.from || e.time > span.to) continue;
    out += fmt::format("{},{:.9f},{},{},{}\n", e.tick, e.time, quoted(e.kind), quoted(e.name),
                       quoted(e.detail));
  }
  return out;
}

void put(const ExportArguments& arguments, const std::string& text) {
  if (arguments.out.empty()) {
    std::fwrite(text.data(), 1, text.size(), stdout);
  } else {
    core::write_whole_file(arguments.out, text);
  }
}

// One table of all logs: a reload does not end a step.
int export_steps(const ExportArguments& arguments, const std::vector<std::string>& paths,
                 const TimeSpan& span) {
  lab::LogSteps reader;
  for (const std::string& path : paths) {
    const lab::Log log = lab::read_log(path, {.all_rows = true, .inputs = true});
    if (!log.complete) fmt::print(stderr, "warning: the log '{}' was cut off\n", log.path);
    reader.add(log);
  }
  lab::RunSteps steps = reader.steps();
  std::erase_if(steps.rows, [&](const lab::StepRow& row) {
    return row.time < span.from || row.time > span.to;
  });
  put(arguments, lab::steps_csv(steps.rows, steps.feet));
  return kGood;
}

int run_export(const ExportArguments& arguments) {
  const TimeSpan span = read_span(arguments.from, arguments.to);
  std::vector<lab::Log> logs;
  const std::vector<std::string> paths = run_logs(arguments.log);
  require_no_input("-o", arguments.out, paths);
  if (arguments.steps) return export_steps(arguments, paths, span);
  for (const std::string& path : paths) {
    logs.push_back(lab::read_log(path, {.all_rows = arguments.all, .inputs = false}));
  }
  require_part_of(logs, span);
  std::string text;
  for (const lab::Log& log : logs) {
    if (!log.complete) fmt::print(stderr, "warning: the log '{}' was cut off\n", log.path);
    std::string part = arguments.events ? events_csv(log, span) : signals_csv(arguments, log, span);
    if (!text.empty()) {
      const std::size_t head = part.find('\n') + 1;
      if (text.compare(0, head, part, 0, head) != 0) {
        throw std::runtime_error(fmt::format(
            "the run goes on in '{}' with other signals: export its logs one by one, or choose "
            "with --signals what all have",
            log.path));
      }
      part.erase(0, head);
    }
    text += part;
  }
  put(arguments, text);
  return kGood;
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "A log as CSV: signals, events, or steps");
  command->add_option("LOG", arguments->log, "log.mcap, or the folder it is in")->required();
  command->add_flag("--csv", arguments->csv, "CSV (the only format so far)");
  auto* signals =
      command->add_option("--signals", arguments->signals, "Names or globs, e.g. \"com.pos.*\"");
  signals->delimiter(',');
  auto* all =
      command->add_flag("--all", arguments->all, "All rows, not only the evenly spaced ones");
  auto* events = command->add_flag("--events", arguments->events, "Events instead of signals")
                     ->excludes(signals)
                     ->excludes(all);
  command->add_flag("--steps", arguments->steps, "Steps instead of signals: one row a touchdown")
      ->excludes(signals)
      ->excludes(all)
      ->excludes(events);
  command->add_option("--from", arguments->from, "Begins at this time, e.g. 2s");
  command->add_option("--to", arguments->to, "Ends at this time");
  command->add_option("-o,--output", arguments->out, "Output file, instead of stdout");
  command->footer(
      "Example: footfall export out/run --csv --signals \"com.pos.*\" --from 2s --to 3s");
  command->callback(
      [arguments, &exit_code] { exit_code = guarded([&] { return run_export(*arguments); }); });
}

}  // namespace footfall::apps
