// `footfall run SCENARIO`: runs one seed, prints each expectation's verdict and one JSON object,
// writes the log.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/log/report_command.h"
#include "apps/run/first_state.h"
#include "apps/run/run_setup.h"
#include "apps/run/stub_setup.h"
#include "apps/run/world_settings.h"
#include "apps/shared/commands.h"
#include "behaviors/check/physics/check.h"
#include "core/text/json_text.h"
#include "core/text/whole_file.h"
#include "hal/sensors/faults.h"
#include "lab/judge/scenario_run.h"
#include "lab/scenario/edits.h"
#include "lab/scenario/loader.h"
#include "lab/scenario/variation.h"

namespace footfall::apps {
namespace {

// Refuses options whose value the scenario defines.
void refuse_options(const RunOptions& options) {
  constexpr std::array kSaid = {"--robot", "--world", "--for",           "--steps", "--push",
                                "--goal",  "--film",  "--goal-velocity", "--reload"};
  for (const std::string& given : options.given) {
    if (std::ranges::find(kSaid, given) == kSaid.end()) continue;
    throw InputError(given + ": error: a scenario says that itself: " + options.behavior);
  }
}

struct CheckedScenario {
  lab::ScenarioDescription scenario;
  sim::WorldDescription world;
};

CheckedScenario load_checked(const RunOptions& options) {
  core::Diagnostics diagnostics;
  const lab::ScenarioOptions how = {search_path(), split_settings(options.set, diagnostics)};
  lab::ScenarioDescription scenario = lab::load_scenario(options.behavior, how, diagnostics);
  print_diagnostics(diagnostics);
  if (diagnostics.has_errors()) throw InputError("");
  if (!scenario.behavior->has_robot) {
    throw InputError(options.behavior + ": error: its behavior has no `robot:` and cannot be run");
  }
  refuse_shadowed_settings(options, scenario);
  const bool world_given = scenario.world_mark.line != 0;
  sim::WorldDescription world = load_world(scenario.world, scenario.world_from,
                                           lab::place_in_file(scenario, scenario.world_mark),
                                           world_settings(options, world_given));
  world.name += world_settings_text(options);
  world.variation = lab::variation_over(scenario, world.variation);
  world = declared_world(options, std::move(world));
  if (options.backend == "stub" && !world_given && options.world_set.empty()) {
    world = stand_world(std::move(world), scenario.behavior->robot);
  }
  const bool held = options.backend == "stub" || !lab::holds_of(scenario).empty();
  const behaviors::PhysicsWorld facts = physics_world(world, held);
  if (facts.actuators) {  // once more, with the robot as it is in the world
    diagnostics = core::Diagnostics();
    scenario =
        lab::load_scenario(options.behavior, {how.search, how.set, facts.actuators}, diagnostics);
    print_diagnostics(diagnostics);
    if (diagnostics.has_errors()) throw InputError("");
  }
  check_world_fits(world, scenario.behavior->robot, lab::holds_of(scenario));
  core::Diagnostics physics;  // positions refer to the behavior's files
  for (const std::string& file : scenario.behavior_files) physics.add_file(file);
  behaviors::check_physics(*scenario.behavior, physics, facts);
  print_diagnostics(physics);
  if (physics.has_errors()) throw InputError("");
  core::Diagnostics edits;
  for (int k = 0; k < diagnostics.file_count(); ++k) edits.add_file(diagnostics.file(k));
  lab::check_edits(scenario, facts, edits);
  print_diagnostics(edits);
  if (edits.has_errors()) throw InputError("");
  return {std::move(scenario), std::move(world)};
}

void inject(hal::SensorFaults& sensors, lab::InjectedFault fault, bool on) {
  switch (fault) {
    case lab::InjectedFault::mocap_dropout:
      return sensors.fail(hal::SensorGroup::mocap, on);
    case lab::InjectedFault::imu_dropout:
      return sensors.fail(hal::SensorGroup::imu, on);
    case lab::InjectedFault::sensor_dropout:
      return sensors.fail(hal::SensorGroup::all, on);
    case lab::InjectedFault::imu_freeze:
      return sensors.freeze(hal::SensorGroup::imu, on);
    case lab::InjectedFault::mocap_freeze:
      return sensors.freeze(hal::SensorGroup::mocap, on);
    case lab::InjectedFault::led_loss:
      return sensors.hide_markers(on);
    case lab::InjectedFault::planner_dropout:  // of the loop, not of its sensors
      return;
  }
}

// `aids`: grows by the holds that came.
lab::ScenarioHooks make_hooks(Backend& backend, hal::SensorFaults& sensors,
                              std::vector<std::string>& aids) {
  lab::ScenarioHooks hooks;
  hooks.fault = [&sensors](lab::InjectedFault fault, bool on) { inject(sensors, fault, on); };
  sim::MujocoBackend* mujoco = backend.mujoco;
  if (mujoco == nullptr) return hooks;
  hooks.push = [mujoco](const std::string& body, const lab::ScriptedPush& push) {
    return mujoco->push(mujoco->find_body(body), push.force, push.direction, push.duration,
                        push.elevation, push.point);
  };
  hooks.hold = [mujoco, &aids](const model::BodySprings& hold) {
    const int number = mujoco->hold(mujoco->find_body(hold.body.name), hold);
    const std::string name = "hold of " + hold.body.name;
    if (number >= 0 && std::ranges::find(aids, name) == aids.end()) aids.push_back(name);
    return number;
  };
  hooks.release = [mujoco](int hold) { mujoco->release(hold); };
  return hooks;
}

// Written beside the log: the result, the run's metrics, the trace for --bless.
void write_results(const RunOptions& options, const lab::ScenarioDescription& scenario,
                   const lab::RunIdentity& id, const lab::ScenarioRun& done) {
  const auto figures = lab::summary_json(id, done.run, true);
  core::write_whole_file(options.log + "/summary.json", core::json_text(figures, 2) + "\n");
  core::write_whole_file(options.log + "/timing.json",
                         core::json_text(lab::timing_json(done.run), 2) + "\n");
  core::write_whole_file(
      options.log + "/result.json",
      core::json_text(lab::outcome_json(scenario, done.outcome, figures), 2) + "\n");
  if (scenario.golden) {
    lab::write_golden(options.log + "/golden.csv", *scenario.golden, done.trace);
  }
}

}  // namespace

int run_scenario_file(RunOptions options) {
  refuse_options(options);
  separate_world_settings(options);
  const CheckedScenario checked = load_checked(options);
  const lab::ScenarioDescription& scenario = checked.scenario;
  const bool seed_given = std::ranges::find(options.given, "--seed") != options.given.end();
  if (!seed_given) options.seed = scenario.seeds.front();
  const behaviors::Behavior& behavior = *scenario.behavior;
  model::Draw drawn;
  const sim::WorldDescription world = draw_world(options, behavior, checked.world, drawn);
  Backend backend = make_backend(options, behavior, world);
  hal::SensorFaults sensors(*backend.hardware);
  std::vector<std::string> aids = backend.constraints;
  const lab::ScenarioHooks hooks = make_hooks(backend, sensors, aids);
  const auto problems = lab::unsupported(scenario, hooks);
  if (!problems.empty()) throw InputError(fmt::format("{}", fmt::join(problems, "\n")));
  engine::ControlLoop loop(behavior, sensors, loop_settings(options, world));

  lab::RunSpec spec = make_spec(options, core::stop_on_signals());
  schedule_push(drawn, backend, behavior, spec);
  lab::RunIdentity id = identity_of(options, behavior, world, sensors, backend, drawn);
  const auto link = attach_link(options, loop, physics_world(checked.world, true), spec);
  const auto folder = claim_folder(options, scenario.name);
  const auto log = open_log(options, behavior, world, id);
  spec.log = log.get();
  const bool status = spec.status != nullptr;
  lab::ScenarioRun done = from_first_state(behavior, world, [&] {
    return lab::run_scenario(scenario, options.seed, loop, hooks, std::move(spec));
  });
  if (status) std::fputs("\r\033[K", stderr);
  done.outcome.log = id.log;
  id.constraints = aids;
  id.footholds = drawn_footholds(backend);
  if (log) {
    log->close();
    write_results(options, scenario, id, done);
  }
  FILE* const people = options.json ? stderr : stdout;
  if (!options.quiet) {
    std::fputs(lab::summary_text(id, done.run).c_str(), people);
    std::fputs(lab::outcome_text(scenario, done.outcome).c_str(), people);
    if (link) std::fputs(live_text(options.live, *link).c_str(), people);
    if (log) fmt::print(people, "  log          {}\n", id.log);
  }
  int report_code = kGood;
  if (log && !options.no_report) {
    ReportArguments report;
    report.log = id.log;
    report_code = write_report_files(report, options.json || options.quiet ? stderr : stdout);
  }
  if (options.json) {
    const auto json = lab::outcome_json(scenario, done.outcome, lab::summary_json(id, done.run));
    fmt::print("{}\n", core::json_text(json));
  }
  return done.outcome.passed ? report_code : kRobotFailed;
}

}  // namespace footfall::apps
