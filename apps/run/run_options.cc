// CLI11 declarations of `footfall run`; see run_options.h.
#include "apps/run/run_options.h"

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "apps/shared/option_value.h"
#include "apps/shared/time_option.h"

namespace footfall::apps {

void add_run_options(CLI::App& command, RunOptions& o) {
  command
      .add_option("BEHAVIOR", o.behavior,
                  "Behavior file, or the name of one in behaviors/library; or a scenario file")
      ->required();
  command.add_option("--robot", o.robot, "Robot file or name, instead of the behavior's");
  command
      .add_option("--backend", o.backend,
                  "mujoco (physics) or stub (a stand: actuators without physics)")
      ->check(one_of({"mujoco", "stub"}))
      ->capture_default_str();
  command.add_option("--world", o.world, "World file, or the name of one in sim/worlds")
      ->capture_default_str();
  command.add_option("--for", o.duration_text,
                     "Maximum duration, e.g. 20s (default 20 s, with --steps N 20 s + N s)");
  command.add_option("--steps", o.steps, "Ends after this many steps")->check(above_zero());
  command.add_option("--seed", o.seed, "Seed of all random numbers")
      ->check(at_least(0, "a whole number from 0 on"))
      ->capture_default_str();
  command.add_option("--variation", o.variation, "off: the seed draws nothing of the world")
      ->check(one_of({"off"}));
  command.add_option("--set", o.set,
                     "NAME=VALUE: a parameter, gain or planner value, e.g. lift_time=160ms");
  command.add_option(
      "--push", o.pushes,
      "FORCE_N,DURATION_S,DIRECTION_DEG,AT with AT a time or `step N phase P`; direction in the "
      "heading frame, 0 forward, 90 left");
  command.add_option("--goal", o.goal, "x,y in m: target position");
  command.add_option("--goal-velocity", o.goal_velocity,
                     "vx,vy in m/s: the goal moves from the start on");
  CLI::Option* const log = command.add_option(
      "--log", o.log,
      "Folder for log.mcap, summary.json, timing.json and the report (default: a "
      "new one in out/run; out/run/latest leads to it)");
  CLI::Option* const no_log = command.add_flag("--no-log", o.no_log, "Writes no files");
  no_log->excludes(log);
  command.add_flag("--no-report", o.no_report, "No report page beside the log");
  command.add_option("--film", o.film, "Writes the run as MP4 (needs ffmpeg)");
  command.add_flag("--log-all", o.log_all, "Logs the derived signals of every tick")
      ->excludes(no_log);
  command
      .add_option("--log-every", o.log_every,
                  "Logs the derived signals of every N-th tick, and of all ticks around "
                  "transitions and faults")
      ->check(above_zero())
      ->capture_default_str();
  command.add_flag("--realtime", o.realtime, "Paced by the wall clock");
  command.add_flag("--reload", o.reload,
                   "Loads a changed behavior file into the run, in a state with `reload: ok`");
  command.add_option("--allow", o.allow, "Permissions of the behavior's scripts: files, processes")
      ->check(one_of({"files", "processes"}));
  add_live_options(command, o.live);
  command.add_flag("--json", o.json, "One JSON object as the last line on stdout");
  command.add_flag("--quiet", o.quiet, "No status line, no summary");
  command.footer("Example: footfall run balance --for 20s --push \"40,0.1,90,step 16 phase 0.5\"");
}

void finish_options(RunOptions& o) {
  if (o.duration_text.empty()) {
    // A step never lasts 1 s (that is a fall), so this bound only ends runs that stopped stepping.
    if (o.steps > 0) o.duration = 20.0 + static_cast<double>(o.steps);
    return;
  }
  o.duration = read_time(o.duration_text, "--for");
  if (o.duration > 0.0) return;
  throw std::runtime_error("--for: error: expected a time above 0 s, got '" + o.duration_text +
                           "'");
}

}  // namespace footfall::apps
