// Components of every run: world, backend, loop settings, log. For behaviors and scenarios.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/run/run_options.h"
#include "apps/shared/commands.h"
#include "core/process/stop_signals.h"
#include "engine/lcm/link.h"
#include "engine/log/writer.h"
#include "engine/tick/control_loop.h"
#include "lab/run/run.h"
#include "lab/run/run_folder.h"
#include "lab/run/run_log.h"
#include "lab/run/summary.h"
#include "sim/mujoco_backend.h"

namespace footfall::apps {

// The backend, and functions that only this backend has.
struct Backend {
  std::unique_ptr<hal::Hardware> hardware;
  sim::MujocoBackend* mujoco = nullptr;
  std::string physics;
  std::vector<std::string> constraints;  // names of the world's external aids
};

// Loads a world by name or path, with `settings` over it. `beside`: a file in whose folder it is
// searched first; `place`: position of the reference, for messages. Prints problems and throws
// InputError.
sim::WorldDescription load_world(const std::string& name, const std::string& beside = {},
                                 const std::string& place = {},
                                 const sim::WorldSettings& settings = {});
// The world as a run declares it: without what is drawn if the options say so, hence judged with
// what it uses.
sim::WorldDescription declared_world(const RunOptions& options, sim::WorldDescription world);
// Refuses a world that does not fit the robot, and springs of its constraints and of `holds` that
// physics cannot integrate: prints why and throws InputError.
void check_world_fits(const sim::WorldDescription& world, const model::RobotDescription& robot,
                      const std::vector<model::BodySprings>& holds = {});
// The world as this run's seed draws it, and the push that it draws into `spec`, which the backend
// must then bring. On the stub only what a stand has is drawn. Throws InputError if a joint could
// begin beyond its limits.
sim::WorldDescription draw_world(const RunOptions& options, const behaviors::Behavior& behavior,
                                 const sim::WorldDescription& world, model::Draw& drawn);
void schedule_push(const model::Draw& drawn, const Backend& backend,
                   const behaviors::Behavior& behavior, lab::RunSpec& spec);
Backend make_backend(const RunOptions& options, const behaviors::Behavior& behavior,
                     const sim::WorldDescription& world);
// After the run: how often a foot got another height of the ground; nothing in a world without.
std::optional<std::int64_t> drawn_footholds(const Backend& backend);
// What the summary says the run was; its log comes later.
lab::RunIdentity identity_of(const RunOptions& options, const behaviors::Behavior& behavior,
                             const sim::WorldDescription& world, const hal::Hardware& sensors,
                             const Backend& backend, const model::Draw& drawn);
engine::LoopSettings loop_settings(const RunOptions& options, const sim::WorldDescription& world);
// Time, steps, pace, log rate, status line, counted allocations.
lab::RunSpec make_spec(const RunOptions& options, const std::atomic<bool>* stop);
// Connects a run to the network of live tuning if its options say so, and prints the address; null
// if not. Edits are checked in `physics`. The result must outlive the run. Throws like make_link().
std::unique_ptr<engine::LcmLink> attach_link(const RunOptions& options, engine::ControlLoop& loop,
                                             const behaviors::PhysicsWorld& physics,
                                             lab::RunSpec& spec);
// Setup data recorded in the log.
lab::LogSource log_source(const RunOptions& options, const sim::WorldDescription& world);
// Makes the folder of the run's files and puts its path into the options; nothing with --no-log.
// Held until the run and its report are done. Throws like lab::RunFolder.
std::optional<lab::RunFolder> claim_folder(RunOptions& options, const std::string& behavior);
// Creates the log in the folder and adds its path to `id`; null with --no-log.
std::unique_ptr<engine::LogWriter> open_log(const RunOptions& options,
                                            const behaviors::Behavior& behavior,
                                            const sim::WorldDescription& world,
                                            lab::RunIdentity& id);

// `footfall run` of a scenario file; returns the exit code. Throws InputError.
int run_scenario_file(RunOptions options);

}  // namespace footfall::apps
