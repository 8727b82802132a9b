// `footfall run`: a behavior on a backend, with a status line, a summary, a log.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "apps/allocations.h"
#include "apps/commands.h"
#include "apps/report_command.h"
#include "apps/run_options.h"
#include "engine/log_writer.h"
#include "hal/stub_backend.h"
#include "lab/run.h"
#include "lab/run_log.h"
#include "lab/summary.h"
#include "sim/disturbance.h"
#include "sim/mujoco_backend.h"

namespace footfall::apps {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> g_stop{false};

void on_interrupt(int) { g_stop.store(true); }

// A mistake in the input: printed as it is, exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

sim::WorldDescription load_world(const std::string& name) {
  core::Diagnostics diagnostics;
  const std::string file = sim::find_world_file(name, search_path());
  sim::WorldDescription world;
  if (file.empty()) {
    if (name != "flat")
      throw InputError(name + ": error: no such world file, and no sim/worlds/" + name +
                       ".yaml in the search path");
    return world;
  }
  world = sim::load_world(file, diagnostics);
  if (!diagnostics.has_errors()) sim::check_supported(world, diagnostics);
  std::fputs(diagnostics.to_string().c_str(), stderr);
  if (diagnostics.has_errors()) throw InputError("");
  return world;
}

// The backend with what only it can do.
struct Backend {
  std::unique_ptr<hal::Hardware> hardware;
  sim::MujocoBackend* mujoco = nullptr;
  std::string physics;
};

Backend make_backend(const RunOptions& options, const behaviors::Behavior& behavior,
                     const sim::WorldDescription& world) {
  Backend backend;
  if (options.backend == "stub") {
    hal::StubSettings settings;
    settings.joints = behavior.robot.joint_count();
    settings.contacts = static_cast<int>(behavior.robot.contacts.size());
    settings.period = behavior.robot.period_s();
    settings.base = {0.0, 0.0, behavior.robot.standing_height};
    for (const auto& joint : behavior.robot.joints) settings.start.push_back(joint.posture);
    backend.hardware = std::make_unique<hal::StubBackend>(settings);
    return backend;
  }
  auto mujoco = std::make_unique<sim::MujocoBackend>(behavior.robot, world, options.seed);
  const sim::PhysicsFacts f = mujoco->facts();
  backend.physics = fmt::format(
      "step 1/{:.0f} s, friction {:g}, feet r <= {:.0f} mm condim {}, damping {:g}, armature {:g}, "
      "constraints {}, mocap bodies {}, mass {:.2f} kg",
      1.0 / f.timestep, f.friction, f.foot_radius_max * 1e3, f.condim_max, f.damping_max,
      f.armature_max, f.equalities, f.mocap_bodies, f.mass);
  backend.mujoco = mujoco.get();
  backend.hardware = std::move(mujoco);
  return backend;
}

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

void set_goal(const RunOptions& options, const behaviors::Behavior& behavior, lab::RunSpec& spec) {
  if (options.goal.empty() && options.goal_velocity.empty()) return;
  if (!lab::has_goal(behavior)) {
    throw InputError("--goal: error: '" + behavior.name +
                     "' has no planner whose goal is a parameter");
  }
  std::string error;
  if (!options.goal.empty()) {
    spec.goal = sim::parse_vector2(options.goal, core::kLength, error);
    if (!spec.goal) throw InputError("--goal: error: " + error);
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

lab::RunSpec make_spec(const RunOptions& options) {
  lab::RunSpec spec;
  spec.max_steps = options.steps;
  spec.max_time = options.duration;
  spec.realtime = options.realtime;
  spec.log_every = options.log_all ? 1 : options.log_every;
  spec.stop = &g_stop;
  if (allocations_are_counted()) {
    spec.arm_allocations = arm_allocations;
    spec.allocations = allocations;
  }
  if (isatty(STDERR_FILENO) && !options.quiet) {
    spec.status = [](const lab::RunStatus& s) {
      std::fprintf(stderr, "\r  t %7.2f s   step %5lld   %5.1f x real time   %-40.40s", s.time,
                   static_cast<long long>(s.steps), s.real_time_factor, s.state.c_str());
      std::fflush(stderr);
    };
  }
  return spec;
}

// Writes a small text file whole or not at all.
void write_file(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".part";
  {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error("cannot write '" + temporary + "'");
  }
  fs::rename(temporary, path);
}

std::unique_ptr<engine::LogWriter> open_log(const RunOptions& options,
                                            const behaviors::Behavior& behavior,
                                            const sim::WorldDescription& world,
                                            lab::RunIdentity& id) {
  if (options.no_log) return nullptr;
  std::error_code error;
  fs::create_directories(options.log, error);
  if (error)
    throw std::runtime_error("cannot create the log's folder '" + options.log +
                             "': " + error.message());
  id.log = options.log + "/log.mcap";
  return std::make_unique<engine::LogWriter>(
      id.log, behavior.signals,
      lab::make_log_header(behavior, world.name, options.backend, options.seed));
}

int run_behavior(const RunOptions& options) {
  if (!options.film.empty() && (options.no_log || options.no_report)) {
    throw InputError(
        "--film: error: a film is made from the log with the report: leave out --no-log and "
        "--no-report");
  }
  auto behavior = load_or_explain(options.behavior, options.robot, options.set, true);
  if (!behavior) return kBadInput;
  if (!behavior->has_robot) {
    throw InputError(behavior->path +
                     ": error: a behavior without `robot:` cannot be run; see `footfall trace`");
  }
  const sim::WorldDescription world = load_world(options.world);
  Backend backend = make_backend(options, *behavior, world);
  engine::LoopSettings settings;
  settings.deviation = {world.control_model.mass_scale, world.control_model.com_shift};
  settings.planner_latency = world.planner_latency;
  settings.surface = world.surface;
  settings.lockstep = !options.realtime;
  settings.seed = options.seed;
  const auto allows = [&](const char* what) {
    return std::find(options.allow.begin(), options.allow.end(), what) != options.allow.end();
  };
  settings.script_access = {allows("files"), allows("processes")};
  engine::ControlLoop loop(*behavior, *backend.hardware, settings);

  lab::RunSpec spec = make_spec(options);
  schedule_pushes(options, backend, spec);
  set_goal(options, *behavior, spec);
  lab::RunIdentity id = {behavior->name,           behavior->robot.name, world.name,
                         backend.hardware->name(), options.seed,         "",
                         backend.physics};
  const auto log = open_log(options, *behavior, world, id);
  spec.log = log.get();

  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  const lab::RunResult result = lab::run(loop, spec);
  if (spec.status) std::fputs("\r\033[K", stderr);
  if (log) {
    log->close();
    write_file(options.log + "/summary.json", lab::summary_json(id, result, true).dump(2) + "\n");
    write_file(options.log + "/timing.json", lab::timing_json(result).dump(2) + "\n");
  }
  if (!options.quiet)
    std::fputs(lab::summary_text(id, result).c_str(), options.json ? stderr : stdout);
  if (!options.quiet && log)
    fmt::print(options.json ? stderr : stdout, "  log          {}\n", id.log);
  int report_code = kGood;
  if (log && !options.no_report) {
    ReportArguments report;
    report.log = id.log;
    report.film = options.film;
    report_code = write_report_files(report, options.json || options.quiet ? stderr : stdout);
  }
  if (options.json) fmt::print("{}\n", lab::summary_json(id, result).dump());
  const bool failed = result.end == lab::RunEnd::fall || result.end == lab::RunEnd::fault;
  return failed ? kRobotFailed : report_code;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Runs a behavior on a backend, headless and as fast as it goes");
  add_run_options(*command, *options);
  command->callback([options, &exit_code] {
    try {
      finish_options(*options);
      exit_code = run_behavior(*options);
    } catch (const InputError& error) {
      if (*error.what()) std::fprintf(stderr, "%s\n", error.what());
      exit_code = kBadInput;
    } catch (const std::exception& error) {
      const std::string text = error.what();
      const bool ours = text.find("error: ") != std::string::npos;  // names a file of the user's
      std::fprintf(stderr, "%s%s\n", ours ? "" : "footfall: error: ", text.c_str());
      exit_code = ours ? kBadInput : kMachineFailed;
    }
  });
}

}  // namespace footfall::apps
