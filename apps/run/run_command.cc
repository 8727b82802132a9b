// `footfall run`: runs a behavior on a backend, with a status line, a summary, a log.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/log/report_command.h"
#include "apps/run/first_state.h"
#include "apps/run/run_options.h"
#include "apps/run/run_reload.h"
#include "apps/run/run_setup.h"
#include "apps/run/stub_setup.h"
#include "apps/run/world_settings.h"
#include "apps/shared/commands.h"
#include "apps/shared/output_option.h"
#include "core/text/json_text.h"
#include "core/text/whole_file.h"
#include "engine/realtime/executive.h"
#include "lab/run/run.h"
#include "lab/run/summary.h"
#include "lab/scenario/loader.h"
#include "sim/world/push.h"

namespace footfall::apps {
namespace {

void schedule_pushes(const RunOptions& options, Backend& backend, lab::RunSpec& spec) {
  if (options.pushes.size() > sim::kMaxPushes) {
    throw InputError(fmt::format("--push: error: at most {} of them, got {}", sim::kMaxPushes,
                                 options.pushes.size()));
  }
  for (const std::string& text : options.pushes) {
    std::string error;
    const auto push = sim::parse_push(text, error);
    if (!push) throw InputError("--push: error: " + error);
    if (!backend.mujoco)
      throw InputError("--push: error: the backend '" + options.backend +
                       "' has no physics to push in");
    const int body = backend.mujoco->find_body(push->body);
    if (body < 0) throw InputError("--push: error: the robot has no body '" + push->body + "'");
    lab::ScheduledEvent event;
    if (const auto* time = std::get_if<sim::AtTime>(&push->at)) {
      event.at_time = time->seconds;
      if (options.duration > 0.0 && time->seconds >= options.duration) {
        throw InputError(
            fmt::format("--push: error: {:g} s is after the run's end at {:g} s (--for)",
                        time->seconds, options.duration));
      }
    } else {
      event.at_step = std::get<sim::AtStep>(push->at).step;
      event.phase = std::get<sim::AtStep>(push->at).phase;
    }
    event.label = text;
    sim::MujocoBackend* mujoco = backend.mujoco;
    event.fire = [mujoco, body, p = *push] {
      mujoco->push(body, p.force, p.direction, p.duration);
    };
    spec.events.push_back(std::move(event));
  }
}

// The parameter that is the goal of the first planner; requires lab::has_goal.
const behaviors::ParameterInfo& goal_parameter(const behaviors::Behavior& behavior) {
  const int index = behavior.parameter_of_slot(behavior.planners.front().goal_slot);
  return behavior.parameters[static_cast<std::size_t>(index)];
}

// The options move the goal like an operator does, so it must be live.
void check_goal_is_live(const behaviors::Behavior& behavior, const std::string& option) {
  const behaviors::ParameterInfo& goal = goal_parameter(behavior);
  if (goal.live) return;
  throw InputError(fmt::format(
      "{}: error: parameter '{}' of '{}' is not live{}; --set {}=\"[1 m, 0 m]\" sets where it {}",
      option, goal.name, behavior.name, goal.variable ? ": the behavior's own actions set it" : "",
      goal.name, goal.variable ? "begins" : "is"));
}

void check_goal_range(const behaviors::Behavior& behavior, const std::array<double, 2>& values) {
  const behaviors::ParameterInfo& goal = goal_parameter(behavior);
  for (const double value : values) {
    if (!goal.has_range() || (value >= goal.min && value <= goal.max)) continue;
    throw InputError(fmt::format("--goal: error: {:g} is outside the range of '{}', {:g} to {:g}",
                                 value, goal.name, goal.min, goal.max));
  }
}

void set_goal(const RunOptions& options, const behaviors::Behavior& behavior, lab::RunSpec& spec) {
  if (options.goal.empty() && options.goal_velocity.empty()) return;
  if (!lab::has_goal(behavior)) {
    throw InputError("--goal: error: '" + behavior.name +
                     "' has no planner whose goal is a parameter");
  }
  check_goal_is_live(behavior, options.goal.empty() ? "--goal-velocity" : "--goal");
  std::string error;
  if (!options.goal.empty()) {
    spec.goal = sim::parse_vector2(options.goal, core::kLength, error);
    if (!spec.goal) throw InputError("--goal: error: " + error);
    check_goal_range(behavior, *spec.goal);
  }
  if (!options.goal_velocity.empty()) {
    spec.goal_velocity = sim::parse_vector2(options.goal_velocity, core::kVelocity, error);
    if (!spec.goal_velocity) throw InputError("--goal-velocity: error: " + error);
  }
  for (const engine::EditBatch& edit : lab::goal_edits(behavior, spec)) {
    const auto reasons = engine::reasons_against(behavior, edit, 0);
    if (!reasons.empty()) throw InputError("--goal: error: " + reasons.front());
  }
}

// Summary, files beside the log, report, JSON. `id.log` is empty without a log, `link` null without
// a network. Returns the report's exit code.
int show_result(const RunOptions& options, const lab::RunIdentity& id, const lab::RunResult& result,
                const engine::LcmLink* link) {
  const bool log = !id.log.empty();
  std::FILE* const text = options.json ? stderr : stdout;
  if (log) {
    core::write_whole_file(options.log + "/summary.json",
                           core::json_text(lab::summary_json(id, result, true), 2) + "\n");
    core::write_whole_file(options.log + "/timing.json",
                           core::json_text(lab::timing_json(result), 2) + "\n");
  }
  if (!options.quiet) {
    std::fputs(lab::summary_text(id, result).c_str(), text);
    if (link) std::fputs(live_text(options.live, *link).c_str(), text);
    if (log) fmt::print(text, "  log          {}\n", id.log);
    if (log && result.reloads > 0) {
      fmt::print(text, "  goes on in   {}{}\n", lab::reload_log(options.log, 1),
                 result.reloads > 1 ? fmt::format(" ... reload-{}", result.reloads) : "");
    }
  }
  int report_code = kGood;
  if (log && !options.no_report) {
    ReportArguments report;
    report.log = id.log;
    report.film = options.film;
    report_code = write_report_files(report, options.json || options.quiet ? stderr : stdout);
  }
  if (options.json) {
    auto json = lab::summary_json(id, result);
    if (link) json["live"] = live_json(options.live, *link);
    fmt::print("{}\n", core::json_text(json));
  }
  return report_code;
}

// A run without the push that was asked for has not tried what it should; one that was stopped by
// hand has not had the time.
bool has_failed(const lab::RunResult& result) {
  const bool missed = !result.missed.empty() && result.end != lab::RunEnd::stopped;
  return missed || result.end == lab::RunEnd::fall || result.end == lab::RunEnd::fault;
}

void check_duration(const RunOptions& options, const model::RobotDescription& robot) {
  constexpr double kRounding = 1e-6;  // of a period
  if (options.duration == 0.0 || options.duration >= robot.period_s() * (1.0 - kRounding)) return;
  throw InputError(fmt::format(
      "--for: error: expected at least a tick of '{}', {:.3g} ms, got '{}': nothing would be run",
      robot.name, robot.period_s() * 1e3, options.duration_text));
}

int run_behavior(RunOptions options) {
  if (!options.film.empty() && (options.no_log || options.no_report)) {
    throw InputError(
        "--film: error: a film is made from the log with the report: leave out --no-log and "
        "--no-report");
  }
  require_film_name(options.film);
  separate_world_settings(options);
  const bool world_given = std::ranges::find(options.given, "--world") != options.given.end();
  sim::WorldDescription declared = declared_world(
      options, load_world(options.world, {}, {}, world_settings(options, world_given)));
  declared.name += world_settings_text(options);
  const behaviors::PhysicsWorld physics = physics_world(declared, options.backend == "stub");
  auto behavior = load_or_explain(options.behavior, options.robot, options.set, &physics);
  if (!behavior) return kBadInput;
  if (!behavior->has_robot) {
    throw InputError(behavior->path +
                     ": error: a behavior without `robot:` cannot be run; see `footfall trace`");
  }
  check_duration(options, behavior->robot);
  if (options.backend == "stub" && !world_given && options.world_set.empty()) {
    declared = stand_world(std::move(declared), behavior->robot);
  }
  check_world_fits(declared, behavior->robot);
  model::Draw drawn;
  const sim::WorldDescription world = draw_world(options, *behavior, declared, drawn);
  Backend backend = make_backend(options, *behavior, world);
  engine::ControlLoop loop(*behavior, *backend.hardware, loop_settings(options, world));

  lab::RunSpec spec = make_spec(options, core::stop_on_signals());
  schedule_pushes(options, backend, spec);
  schedule_push(drawn, backend, *behavior, spec);
  set_goal(options, *behavior, spec);
  lab::RunIdentity id = identity_of(options, *behavior, world, *backend.hardware, backend, drawn);
  const auto link = attach_link(options, loop, physics, spec);
  const auto folder = claim_folder(options, behavior->name);
  const auto log = open_log(options, *behavior, world, id);
  spec.log = log.get();
  LiveFiles live = watch_files(options, loop, *backend.hardware, world, physics, spec);
  spec.reloads = live.reloads.get();

  const lab::RunResult result =
      from_first_state(*behavior, world, [&] { return lab::run(loop, spec); });
  id.footholds = drawn_footholds(backend);
  live.watch.reset();
  if (live.reloads) live.reloads->close();
  if (spec.status) std::fputs("\r\033[K", stderr);
  if (log) log->close();
  const int report_code = show_result(options, id, result, link.get());
  return has_failed(result) ? kRobotFailed : report_code;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Runs a behavior on a backend, headless and as fast as it goes");
  add_run_options(*command, *options);
  command->callback([options, command, &exit_code] {
    for (const CLI::Option* option : command->get_options()) {
      if (option->count() > 0) options->given.push_back(option->get_name());
    }
    const auto run = [&] {
      finish_options(*options);
      return lab::is_scenario_file(options->behavior) ? run_scenario_file(*options)
                                                      : run_behavior(*options);
    };
    exit_code = guarded(run, kMachineFailed);
  });
}

}  // namespace footfall::apps
