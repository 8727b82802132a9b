// Writes a run into its log: every tick with what came from outside, and an event for each
// transition, mark, step, plan and fault. Called between control and backend, outside its timing.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/log/writer.h"
#include "engine/tick/control_loop.h"
#include "lab/figures/step_counter.h"

namespace footfall::lab {

// Of logs: the key `format` of the metadata `run`; logs without one are of format 1. A replay wants
// the present one: a reader reads all. 2 has scripts_stuck among the inputs, and faults of 19
// kinds.
inline constexpr int kLogFormat = 2;

class RunLog {
 public:
  using Said = std::function<void(double time, const std::string& text)>;
  // Makes room, and leaves the loop as it is; any thread. log may be null: then nothing is written,
  // and `said`, if there is one, is told what `log:` actions and scripts say.
  RunLog(engine::ControlLoop& loop, engine::LogWriter* log, Said said = nullptr);
  // Before the loop's first tick, or its first since it took over: records from then on. Allocates
  // nothing.
  void begin();
  void after_start();
  // Before a tick's compute(): the states that are active now. Allocates nothing.
  void before_tick() noexcept;
  void after_tick(const StepEvent& step);
  void event(std::string_view kind, std::string_view name, std::string_view detail);
  std::string state_name() const;
  // Atomic states at the start of the tick: what a fault's tick has left.
  std::span<const int> states_before() const noexcept { return states_before_; }
  // Of the first fault `execution`; empty: there was none.
  const std::string& first_execution_error() const noexcept { return first_execution_error_; }

 private:
  void write_edits();
  void write_texts();
  void say(const std::string& text, std::string_view from);
  void write_plans();
  bool write_faults();
  engine::ControlLoop& loop_;
  engine::LogWriter* log_;
  Said said_;
  engine::InputTrace trace_;
  core::FaultCounters seen_faults_;
  std::vector<std::array<double, 3>> last_targets_;
  std::vector<int> states_before_;
  std::string first_execution_error_;
};

// What a run was made from besides its behavior.
struct LogSource {
  std::string world = "flat", backend = "mujoco";
  std::string world_file;  // empty: none
  engine::LoopSettings settings;
  std::vector<std::pair<std::string, std::string>> set;  // --set NAME=VALUE
  std::string command;                                   // as it was typed, for people
  double friction = 0.0;                                 // of the ground; 0: unknown
  bool elastic = false;                                  // series-elastic actuators
  model::Terrain terrain;            // of the simulation; the settings have the believed one
  bool own_actuators = false;        // the world has actuators in the place of the robot's
  bool aids = false;                 // the world has external aids
  bool sensor_errors = false;        // the world's sensors have errors
  std::vector<std::string> markers;  // by name; empty: the robot's, if logged
  int row_every = 6;                 // ticks; 1: derived signals of all ticks
};

// The log's header: behavior, robot, world, seed, states, and all files it was loaded from.
engine::LogHeader make_log_header(const behaviors::Behavior& behavior, const LogSource& source);

}  // namespace footfall::lab
