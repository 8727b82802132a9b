// CLI11 declarations of `footfall tune`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/option_value.h"
#include "apps/tune/model/options.h"
#include "apps/tune/model/quantity.h"
#include "apps/tune/session.h"

namespace footfall::apps {
namespace {

using Options = std::shared_ptr<TuneOptions>;

// Adds an option for a time with unit, stored in `seconds`.
void add_time(CLI::App& command, const std::string& name, double& seconds,
              const std::string& text) {
  command.add_option_function<std::string>(
      name,
      [name, &seconds](const std::string& value) {
        const auto read = read_duration(value);
        if (!read) {
          throw CLI::ValidationError(name,
                                     fmt::format("expected a time such as 500ms, got '{}'", value));
        }
        seconds = *read;
      },
      text);
}

int run_action(const TuneOptions& options, int (*action)(const TuneOptions&)) {
  const auto work = [&] {
    try {
      return action(options);
    } catch (const SeveralEngines& several) {
      fmt::print(stderr, "{}", several.what());
      return kRobotFailed;
    }
  };
  return guarded(work, kMachineFailed);
}

CLI::App* add_action(CLI::App& tune, const Options& options, int& exit_code,
                     const std::string& name, const std::string& text,
                     int (*action)(const TuneOptions&)) {
  CLI::App* command = tune.add_subcommand(name, text);
  command->fallthrough();
  command->callback([options, &exit_code, action] { exit_code = run_action(*options, action); });
  return command;
}

void add_edits(CLI::App& tune, const Options& o, int& exit_code) {
  const auto add_common = [&](CLI::App* command) {
    command->add_option("--raise", o->events, "An event, in the same tick; may be repeated")
        ->allow_extra_args(false);
    command->add_option("--revision", o->revision,
                        "Refused unless this many changes were made before (see list --json)");
    command->add_flag("--json", o->json, "The answer as one JSON object");
  };
  CLI::App* set = add_action(tune, o, exit_code, "set",
                             "Changes values: all of them in one tick, or none", tune_set);
  set->add_option("NAME=VALUE", o->names, "lift_time=150ms, goal.x=0.2, \"NAME=[220, 237, 400]\"")
      ->required();
  add_time(*set, "--over", o->over, "Duration of a linear ramp to the values");
  add_common(set);
  set->footer("Example: footfall tune set lift_time=150ms land_time=150ms --over 0.5s");
  CLI::App* ramp =
      add_action(tune, o, exit_code, "ramp", "Changes values by linear ramps", tune_set);
  ramp->add_option("NAME=VALUE", o->names, "As for set")->required();
  add_time(*ramp, "--over", o->over, "Duration of a linear ramp to the values");
  ramp->get_option("--over")->required();
  add_common(ramp);
  ramp->footer("Example: footfall tune ramp goal.x=0.5m --over 3s");
  for (const bool redo : {false, true}) {
    CLI::App* command = add_action(
        tune, o, exit_code, redo ? "redo" : "undo",
        redo ? "Redoes the change that was undone last" : "Undoes the newest change, by any user",
        redo ? +[](const TuneOptions& options) { return tune_undo(options, true); }
             : +[](const TuneOptions& options) { return tune_undo(options, false); });
    command->add_option("N", o->count, "Number of changes")->check(CLI::Range(1, 1000));
    add_time(*command, "--over", o->over, "Duration of the ramp (default: that of the change)");
    command->add_flag("--json", o->json, "Each answer as a JSON object");
  }
  CLI::App* raise =
      add_action(tune, o, exit_code, "raise", "Raises events of the behavior", tune_raise);
  raise->add_option("EVENT", o->names, "In this order, in one tick")->required();
  raise->add_flag("--json", o->json, "The answer as one JSON object");
}

void add_views(CLI::App& tune, const Options& o, int& exit_code) {
  CLI::App* engines =
      add_action(tune, o, exit_code, "list-engines",
                 "The engines on the network, with their sessions", tune_list_engines);
  engines->alias("who");
  engines->add_flag("--json", o->json, "One JSON object");
  CLI::App* list = add_action(tune, o, exit_code, "list",
                              "Live parameters and gains with values, ranges, meaning", tune_list);
  list->add_option("GLOB", o->names, "Only these, with * and ?, or a part of the name");
  list->add_flag("--names", o->only_names, "Names alone");
  list->add_flag("--json", o->json, "One JSON object, values in SI");
  list->footer("Example: footfall tune list \"gains.single.*\"");
  CLI::App* get = add_action(tune, o, exit_code, "get",
                             "NAME=VALUE lines, exact, as `set` takes them", tune_get);
  get->add_option("NAME", o->names, "Names or patterns")->required();
  get->add_flag("--json", o->json, "One JSON object, values in SI");
  CLI::App* diff = add_action(tune, o, exit_code, "diff",
                              "Values that differ from the behavior's file", tune_diff);
  diff->add_flag("--json", o->json, "One JSON object, values in SI");
  CLI::App* watch =
      add_action(tune, o, exit_code, "watch",
                 "Prints signals and values as they arrive, and all users' edits", tune_watch);
  watch->add_option("NAME", o->names, "Signals, parameters, gains; patterns");
  watch->add_flag("--json", o->json, "One JSON object a line");
  add_time(*watch, "--for", o->duration,
           "Time of the run from the first line to the last one (default: until Ctrl-C, or the "
           "run's end)");
  add_time(*watch, "--every", o->every, "Minimum time between lines");
  watch->footer("Example: footfall tune watch com.pos.z lift_time --every 100ms");
}

void add_files(CLI::App& tune, const Options& o, int& exit_code) {
  CLI::App* save = add_action(tune, o, exit_code, "save",
                              "Saves the current values to the behavior's file", tune_save);
  save->add_option("NAME", o->names, "Only these; names or patterns");
  CLI::Option* const to = save->add_option(
      "--to", o->file,
      "Writes to this file: a new overlay, which begins with `base:`, or an existing one");
  save->add_flag("--into-base", o->into_base,
                 "Writes each value where it is defined, also into a base of the file that runs")
      ->excludes(to);
  save->add_flag("--yes", o->yes, "Writes without asking");
  save->add_flag("--dry-run", o->dry_run, "Shows what would change, writes nothing");
  save->footer("Example: footfall tune save --to mine.yaml");
  CLI::App* key = add_action(tune, o, exit_code, "key",
                             "Creates a key for users of other machines or accounts", tune_key);
  key->add_option("FILE", o->file, "A new file; only its owner may read it")->required();
  key->footer("Example: footfall tune key ~/robot.key");
}

}  // namespace

void add_tune_command(CLI::App& app, int& exit_code) {
  auto o = std::make_shared<TuneOptions>();
  CLI::App* tune = app.add_subcommand(
      "tune", "Changes parameters and gains of a run with --lcm: full screen, or a sub-command");
  tune->require_subcommand(0, 1);
  tune->add_option("--url", o->url, "LCM URL (default: only this host, as `run --lcm`)");
  tune->add_option("--key", o->key, "File with the key (default: the user's own)");
  tune->add_flag("--open", o->open, "Without a key, for `run --lcm-open`");
  tune->add_option("--prefix", o->prefix, "Prefix of the channel names, as `run --lcm-prefix`")
      ->capture_default_str();
  tune->add_option("--session", o->session,
                   "The engine to talk to, by its session (see list-engines); needed if there are "
                   "several")
      ->check(above_zero());
  tune->add_option("--who", o->who, "Your name for other users and the log (default: user@host)");
  add_time(*tune, "--timeout", o->timeout, "How long to wait for an answer (default 3 s)");
  add_views(*tune, o, exit_code);
  add_edits(*tune, o, exit_code);
  add_files(*tune, o, exit_code);
  tune->footer(
      "Exit codes: 0 done, 1 refused or several engines, 2 the input is wrong, 3 no engine "
      "answers.\n"
      "Example: footfall tune set lift_time=150ms");
  tune->callback([tune, o, &exit_code] {
    if (tune->get_subcommands().empty()) exit_code = run_action(*o, tune_screen);
  });
}

}  // namespace footfall::apps
