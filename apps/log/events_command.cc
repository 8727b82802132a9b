// `footfall events`: the events of a run, from its log, one line an event.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <locale>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/log_argument.h"
#include "apps/shared/time_option.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/json_text.h"
#include "core/text/printable.h"
#include "core/units/units.h"
#include "lab/log/reader.h"

namespace footfall::apps {
namespace {

struct EventsOptions {
  std::string log;
  std::vector<std::string> kinds;
  std::string from, to;  // as written
  bool json = false;
};

// A kind that no log can contain is an error; one that only this log lacks is not.
void check_kinds(const std::vector<std::string>& kinds, const lab::Log& log) {
  std::set<std::string> known = {"transition", "mark", "step",   "log", "fault", "plan",
                                 "push",       "edit", "reload", "gap", "end"};
  for (const lab::LoggedEvent& event : log.events) known.insert(event.kind);
  const std::vector<std::string> names(known.begin(), known.end());
  for (const std::string& kind : kinds) {
    if (known.contains(kind)) continue;
    throw std::runtime_error(fmt::format("--kind: error: unknown kind '{}'{}", kind,
                                         core::did_you_mean_or_list(kind, names)));
  }
}

std::string text_of(const lab::LoggedEvent& event) {
  const std::string name = core::on_one_line(event.name), detail = core::on_one_line(event.detail);
  const char* between = event.kind == "transition" ? "-> " : "";
  return fmt::format("{:10.4f} s  {:<10} {}{}{}{}\n", event.time, core::on_one_line(event.kind),
                     name, detail.empty() ? "" : "  ", detail.empty() ? "" : between, detail);
}

// `a = 1, b[1] = 2 over 150 ticks`: {"values": {"a": 1, "b[1]": 2}}.
void add_values(const std::string& detail, nlohmann::ordered_json& line) {
  std::istringstream text(detail);
  text.imbue(std::locale::classic());
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  std::string name, equals;
  double value = 0.0;
  while (text >> name >> equals && equals == "=" && text >> value) {
    values[name] = value;
    if (text.peek() == ',') text.get();
  }
  if (!values.empty()) line["values"] = values;
}

// What the detail of some kinds says, as values: of a fault how often, where, how much; of a step
// its clearance and flight; of a plan the foothold.
void add_fields(const lab::LoggedEvent& event, nlohmann::ordered_json& line) {
  std::istringstream text(event.detail);
  text.imbue(std::locale::classic());
  std::string word, unit;
  double x = 0.0, y = 0.0, z = 0.0;
  if (event.kind == "fault") {
    std::int64_t count = 0;
    if (text >> count) line["count"] = count;
    if (text.get() == ',' && text >> word >> x >> unit) {
      line.update({{"place", word}, {"value", x}, {"unit", unit}});
    }
  } else if (event.kind == "step") {
    std::string comma, flight;
    if (text >> word >> x >> comma >> flight >> y && word == "clearance" && flight == "flight") {
      line.update({{"clearance_m", x}, {"flight_s", y}});
    }
  } else if (event.kind == "push") {
    std::string newton, second;
    if (text >> x >> newton >> y >> second >> z && newton == "N,") {
      line.update({{"force_N", x}, {"duration_s", y}, {"direction_rad", z}});
    }
  } else if (event.kind == "edit") {
    add_values(event.detail, line);
  } else if (event.kind == "plan" && text >> x >> y >> z) {
    line["target_m"] = {x, y, z};
  }
}

std::string json_of(const lab::LoggedEvent& event) {
  nlohmann::ordered_json line = {
      {"time_s", event.time}, {"kind", event.kind}, {"name", event.name}, {"detail", event.detail}};
  add_fields(event, line);
  return core::json_text(line) + "\n";
}

void print_events(const EventsOptions& options) {
  const TimeSpan span = read_span(options.from, options.to);
  std::vector<lab::Log> logs;
  for (const std::string& path : run_logs(options.log)) logs.push_back(lab::read_log(path));
  require_part_of(logs, span);
  for (const lab::Log& log : logs) {
    check_kinds(options.kinds, log);
    if (!log.complete) {
      fmt::print(stderr, "warning: the log '{}' was cut off; its events end there\n", log.path);
    }
    for (const lab::LoggedEvent& event : log.events) {
      if (event.time < span.from || event.time > span.to) continue;
      const bool asked = options.kinds.empty() ||
                         std::ranges::find(options.kinds, event.kind) != options.kinds.end();
      if (asked) fmt::print("{}", options.json ? json_of(event) : text_of(event));
    }
  }
}

}  // namespace

void add_events_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<EventsOptions>();
  CLI::App* command = app.add_subcommand(
      "events", "Lists the events of a run: transitions, marks, steps, texts, faults");
  command->add_option("LOG", options->log, "log.mcap, or the folder it is in")->required();
  command
      ->add_option(
          "--kind", options->kinds,
          "Only these, commas between: transition, mark, step, log, fault, plan, push, edit, "
          "reload, gap, end")
      ->delimiter(',');
  command->add_option("--from", options->from, "From this time on, e.g. 2.5s");
  command->add_option("--to", options->to, "Up to this time");
  command->add_flag("--json", options->json, "One JSON object a line");
  command->footer("Example: footfall events out/run --kind log,fault --from 2s");
  command->callback([options, &exit_code] {
    const auto work = [&] {
      print_events(*options);
      return kGood;
    };
    exit_code = guarded(work);
  });
}

}  // namespace footfall::apps
