// `footfall trace`: runs the statechart alone, without a robot.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <sstream>

#include "apps/shared/commands.h"
#include "behaviors/statechart/trace.h"
#include "core/text/printable.h"

namespace footfall::apps {
namespace {

int trace_file(const std::string& file, const std::string& events, const std::string& script) {
  const auto behavior = load_or_explain(file, "", {});
  if (!behavior) return kBadInput;
  std::vector<behaviors::TraceStep> steps = behaviors::trace_events(events);
  if (!script.empty()) {
    core::Diagnostics diagnostics;
    const auto read = behaviors::load_trace_script(script, diagnostics);
    std::fputs(diagnostics.to_string().c_str(), stderr);
    if (!read) return kBadInput;
    steps = *read;
  }
  for (const std::string& text : behaviors::unknown_events(*behavior, steps)) {
    fmt::print(stderr, "{}: warning: {}\n", script.empty() ? "--events" : script,
               core::on_one_line(text));
  }
  std::ostringstream text;
  behaviors::trace(*behavior, steps, text);
  std::fputs(text.str().c_str(), stdout);
  return kGood;
}

}  // namespace

void add_trace_command(CLI::App& app, int& exit_code) {
  struct Options {
    std::string file, events, script;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("trace", "Runs the statechart alone: one JSON line an event");
  command->add_option("FILE", options->file, "Behavior file or name")->required();
  auto* events = command->add_option("--events", options->events, "Events, commas between");
  command->add_option("--script", options->script, "YAML list of {after: TIME} and {event: NAME}")
      ->excludes(events);
  command->footer("Example: footfall trace behaviors/library/balance.yaml --events start");
  command->callback([options, &exit_code] {
    exit_code = trace_file(options->file, options->events, options->script);
  });
}

}  // namespace footfall::apps
