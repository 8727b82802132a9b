// Components of a run; see run_setup.h.
#include "apps/run/run_setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/run/stub_setup.h"
#include "apps/shared/commands.h"
#include "behaviors/language/estimators.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/realtime/allocation_count.h"
#include "core/text/json_text.h"
#include "core/text/printable.h"
#include "core/text/search_folders.h"
#include "hal/backends/stub.h"
#include "lab/process/pool.h"
#include "lab/run/run_log.h"
#include "model/mjcf.h"

namespace footfall::apps {

namespace fs = std::filesystem;

sim::WorldDescription load_world(const std::string& name, const std::string& beside,
                                 const std::string& place, const sim::WorldSettings& settings) {
  core::Diagnostics diagnostics;
  std::string file;
  if (!beside.empty()) {
    file = sim::find_world_file((fs::path(beside).parent_path() / name).string(), {});
  }
  const std::vector<std::string> folders =
      beside.empty() ? search_path() : core::search_from(beside, search_path());
  if (file.empty()) file = sim::find_world_file(name, folders);
  sim::WorldDescription world;
  if (file.empty()) {
    if (name != "flat" || !settings.empty()) {
      throw InputError(
          fmt::format("{}: error: unknown world '{}': no such file, and no "
                      "sim/worlds/{}.yaml in the search path{}",
                      place.empty() ? "--world" : place, name, name,
                      core::did_you_mean_or_list(name, core::names_in(folders, "sim/worlds"))));
    }
    return world;
  }
  world = sim::load_world(file, diagnostics, search_path(), settings);
  if (!diagnostics.has_errors()) sim::check_supported(world, diagnostics);
  std::fputs(diagnostics.to_string().c_str(), stderr);
  if (diagnostics.has_errors()) throw InputError("");
  return world;
}

sim::WorldDescription declared_world(const RunOptions& options, sim::WorldDescription world) {
  if (options.variation == "off") world.variation = {};
  return world;
}

void check_world_fits(const sim::WorldDescription& world, const model::RobotDescription& robot,
                      const std::vector<model::BodySprings>& holds) {
  core::Diagnostics diagnostics;
  check_world_fits(world, robot, diagnostics, holds);
  print_diagnostics(diagnostics);
  if (diagnostics.has_errors()) throw InputError("");
}

sim::WorldDescription draw_world(const RunOptions& options, const behaviors::Behavior& behavior,
                                 const sim::WorldDescription& world, model::Draw& drawn) {
  const model::Variation& declared = world.variation;
  model::Variation variation = declared;
  if (options.backend == "stub") {  // what a stand has
    variation = {};
    variation.joints = declared.joints;
    variation.command_delay = declared.command_delay;
    variation.spring = declared.spring;
    variation.coulomb = declared.coulomb;
  }
  if (world.actuators.model == sim::ActuatorModel::ideal) variation.spring = variation.coulomb = {};
  const std::vector<std::string> links = variation.mass.kind == model::Spread::Kind::none
                                             ? std::vector<std::string>()
                                             : model::body_names(behavior.robot.model_path);
  drawn = model::draw(variation, behavior.robot.joint_count(), links, options.seed);
  model::keep_start_within_limits(drawn, behavior.robot);
  model::round_command_delay(drawn, world.actuators.command_delay,
                             behavior.robot.period_s() / world.physics.steps_per_tick);
  return sim::with_draw(world, drawn);
}

void schedule_push(const model::Draw& drawn, const Backend& backend,
                   const behaviors::Behavior& behavior, lab::RunSpec& spec) {
  if (!drawn.push || backend.mujoco == nullptr) return;
  const model::DrawnPush push = *drawn.push;
  const int body = backend.mujoco->find_body(behavior.robot.floating_base);
  lab::ScheduledEvent event;
  event.at_time = push.time;
  event.optional = true;
  event.label = fmt::format("drawn: {:g} N, {:g} s, {:.0f} deg", push.force, push.duration,
                            push.direction * 180.0 / M_PI);
  event.fire = [mujoco = backend.mujoco, body, push] {
    mujoco->push(body, push.force, push.direction, push.duration);
  };
  spec.events.push_back(std::move(event));
}

namespace {

// Parts of the `physics` line that most worlds lack: `, command delay 2 ms, model mass +10 %`.
std::string more_physics(const sim::WorldDescription& world) {
  std::string text;
  if (world.actuators.model == sim::ActuatorModel::series_elastic) {
    text += ", series-elastic actuators";
  }
  if (world.sensors.errors.any()) text += ", sensors with errors";
  if (world.height_error > 0.0) {
    text += fmt::format(", ground height +-{:.3g} mm a step", world.height_error * 1e3);
  }
  if (world.actuators.command_delay > 0.0) {
    text += fmt::format(", command delay {:.3g} ms", world.actuators.command_delay * 1e3);
  }
  const model::ModelDeviation& model = world.control_model;
  const auto percent = [](double scale) { return (scale - 1.0) * 100.0; };
  if (model.mass_scale != 1.0) {
    text += fmt::format(", model mass {:+.3g} %", percent(model.mass_scale));
  }
  constexpr std::size_t kMostListed = 3;  // links
  if (model.mass_scales.size() > kMostListed) {
    const auto scale = [](const auto& link) { return link.second; };
    const auto [least, most] = std::ranges::minmax_element(model.mass_scales, {}, scale);
    text += fmt::format(", model mass of {} links {:+.3g} to {:+.3g} %", model.mass_scales.size(),
                        percent(least->second), percent(most->second));
  } else {
    for (const auto& [link, scale] : model.mass_scales) {
      text += fmt::format(", model mass of {} {:+.3g} %", link, percent(scale));
    }
  }
  for (const auto& [link, shift] : model.com_shift) {
    text += fmt::format(", model CoM of {} {:+.3g} {:+.3g} {:+.3g} mm", link, shift[0] * 1e3,
                        shift[1] * 1e3, shift[2] * 1e3);
  }
  return text;
}

}  // namespace

Backend make_backend(const RunOptions& options, const behaviors::Behavior& behavior,
                     const sim::WorldDescription& world) {
  Backend backend;
  if (options.backend == "stub") {
    backend.hardware = std::make_unique<hal::StubBackend>(stub_settings(behavior.robot, world));
    backend.physics = stub_facts(world);
    return backend;
  }
  auto mujoco = std::make_unique<sim::MujocoBackend>(behavior.robot, world);
  const sim::PhysicsFacts f = mujoco->facts();
  backend.physics = fmt::format(
      "step 1/{:.0f} s, friction {:.3g}, feet r <= {:.0f} mm condim {}, damping {:g}, armature "
      "{:g}, "
      "equality constraints {}, mocap bodies {}, mass {:.2f} kg",
      1.0 / f.timestep, f.friction, f.foot_radius_max * 1e3, f.condim_max, f.damping_max,
      f.armature_max, f.equalities, f.mocap_bodies, f.mass);
  backend.physics += more_physics(world);
  for (const model::BodySprings& aid : world.constraints) backend.constraints.push_back(aid.name);
  backend.mujoco = mujoco.get();
  backend.hardware = std::move(mujoco);
  return backend;
}

std::optional<std::int64_t> drawn_footholds(const Backend& backend) {
  const sim::Footholds* footholds = backend.mujoco ? backend.mujoco->footholds() : nullptr;
  return footholds ? std::optional(footholds->drawn()) : std::nullopt;
}

lab::RunIdentity identity_of(const RunOptions& options, const behaviors::Behavior& behavior,
                             const sim::WorldDescription& world, const hal::Hardware& sensors,
                             const Backend& backend, const model::Draw& drawn) {
  const behaviors::EstimatorInfo& estimator = behaviors::estimator_info(behavior.estimator.type);
  const char* const errors = !world.sensors.errors.any() ? "none"
                             : estimator.needs_imu       ? "used"
                                                         : "unused";
  return {behavior.name,
          behavior.robot.name,
          world.name,
          sensors.name(),
          options.seed,
          "",
          backend.physics,
          lab::unused_torque_loops(behavior, sensors),
          drawn.values,
          backend.constraints,
          std::string(estimator.name),
          errors};
}

engine::LoopSettings loop_settings(const RunOptions& options, const sim::WorldDescription& world) {
  engine::LoopSettings settings;
  settings.deviation = world.control_model;
  settings.planner_latency = world.planner_latency;
  settings.surface = world.surface;
  settings.lockstep = !options.realtime;
  settings.seed = options.seed;
  const auto allows = [&](const char* what) {
    return std::find(options.allow.begin(), options.allow.end(), what) != options.allow.end();
  };
  settings.script_access = {allows("files"), allows("processes")};
  return settings;
}

namespace {

// Prints log messages of the behavior as they occur; limited, so that the summary remains visible.
std::function<void(double, const std::string&)> said_printer(const RunOptions& options) {
  constexpr int kMost = 50;
  const bool status = isatty(STDERR_FILENO) != 0;
  std::FILE* stream = options.json ? stderr : stdout;
  const bool logged = !options.no_log;
  return [stream, status, logged, said = 0](double time, const std::string& text) mutable {
    if (++said > kMost + 1) return;
    if (status) std::fputs("\r\033[K", stderr);
    if (said <= kMost) {
      fmt::print(stream, "  {:8.3f} s   {}\n", time,
                 core::on_one_line(core::printable_lines(text)));
    } else {
      fmt::print(stream, "  ... and more{}\n",
                 logged ? "; all of it: footfall events LOG --kind log" : "");
    }
    std::fflush(stream);
  };
}

}  // namespace

lab::RunSpec make_spec(const RunOptions& options, const std::atomic<bool>* stop) {
  lab::RunSpec spec;
  spec.max_steps = options.steps;
  spec.max_time = options.duration;
  spec.realtime = options.realtime;
  spec.stop = stop;
  if (core::allocations_are_counted()) {
    spec.arm_allocations = core::arm_allocation_count;
    spec.allocations = core::allocation_count;
  }
  if (!options.quiet) spec.said = said_printer(options);
  if (isatty(STDERR_FILENO) && !options.quiet) {
    spec.status = [](const lab::RunStatus& s) {
      std::fprintf(stderr, "\r  t %7.2f s   step %5lld   %5.1f x real time   %-40.40s%s\033[K",
                   s.time, static_cast<long long>(s.steps), s.real_time_factor, s.state.c_str(),
                   s.note.c_str());
      std::fflush(stderr);
    };
  }
  return spec;
}

std::unique_ptr<engine::LcmLink> attach_link(const RunOptions& options, engine::ControlLoop& loop,
                                             const behaviors::PhysicsWorld& physics,
                                             lab::RunSpec& spec) {
  auto link = make_link(options.live, loop, physics);
  spec.live = link.get();
  if (link && !options.quiet) {
    fmt::print(options.json ? stderr : stdout, "live at {}: footfall tune{}\n", options.live.url,
               tune_options_text(options.live));
    std::fflush(options.json ? stderr : stdout);
  }
  return link;
}

namespace {

// The command line, stored in the log: what the run depends on.
std::string command_line(const RunOptions& options) {
  std::vector<std::string> words = {"run", options.behavior};
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {name, value});
  };
  add("--robot", options.robot);
  if (options.backend != "mujoco") add("--backend", options.backend);
  add("--world", options.world);
  add("--variation", options.variation);
  add("--seed", std::to_string(options.seed));
  add("--for", options.duration_text);
  if (options.steps > 0) add("--steps", std::to_string(options.steps));
  for (const std::string& set : options.set) add("--set", set);
  for (const auto& [key, value] : options.world_set) {
    add("--set", fmt::format("world.{}={}", key, value));
  }
  for (const std::string& push : options.pushes) add("--push", push);
  add("--goal", options.goal);
  add("--goal-velocity", options.goal_velocity);
  for (const std::string& access : options.allow) add("--allow", access);
  if (options.realtime) words.emplace_back("--realtime");
  return lab::shell_line(words);
}

}  // namespace

lab::LogSource log_source(const RunOptions& options, const sim::WorldDescription& world) {
  lab::LogSource source;
  source.world = world.name;
  source.backend = options.backend;
  source.world_file = world.path;
  if (options.backend == "mujoco") source.friction = world.friction;
  source.elastic = world.actuators.model == sim::ActuatorModel::series_elastic;
  if (options.backend == "mujoco") source.terrain = sim::terrain_of(world.terrain);
  source.own_actuators = sim::changes_robot(world.actuators);
  source.aids = !world.constraints.empty();
  source.sensor_errors = world.sensors.errors.any();
  source.settings = loop_settings(options, world);
  core::Diagnostics ignored;  // loaded before
  source.set = split_settings(options.set, ignored);
  source.command = command_line(options);
  source.row_every = options.log_all ? 1 : options.log_every;
  return source;
}

std::optional<lab::RunFolder> claim_folder(RunOptions& options, const std::string& behavior) {
  if (options.no_log) return std::nullopt;
  lab::RunFolder folder(options.log, behavior);
  options.log = folder.path();
  return folder;
}

std::unique_ptr<engine::LogWriter> open_log(const RunOptions& options,
                                            const behaviors::Behavior& behavior,
                                            const sim::WorldDescription& world,
                                            lab::RunIdentity& id) {
  if (options.no_log) return nullptr;
  id.log = options.log + "/log.mcap";
  engine::LogHeader header = lab::make_log_header(behavior, log_source(options, world));
  header.run.emplace_back("variation", core::json_text(lab::variation_json(id)));
  if (!id.constraints.empty()) {
    header.run.emplace_back("constraints", fmt::format("{}", fmt::join(id.constraints, ", ")));
  }
  return std::make_unique<engine::LogWriter>(id.log, behavior.signals, header);
}

}  // namespace footfall::apps
