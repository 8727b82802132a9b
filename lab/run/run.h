// One run in lock-step or paced, as an experiment: the executive ticks the control loop, and what
// is attached here fires scheduled events (pushes), moves the goal, feeds metrics, log and status
// line and ends the run after so many steps or seconds.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/realtime/timing_histogram.h"
#include "engine/log/writer.h"
#include "engine/realtime/live_port.h"
#include "engine/tick/control_loop.h"
#include "lab/figures/metrics.h"
#include "lab/run/end.h"

namespace footfall::lab {

// Something to do once, at a time or at a phase of a step.
struct ScheduledEvent {
  std::optional<double> at_time;  // s; without it:
  std::int64_t at_step = 0;       // after this many counted steps ...
  double phase = 0.0;             // ... plus this part of the last step's duration
  std::string label;              // for the log
  std::function<void()> fire;
  bool optional = false;  // the run may end before it
};

struct RunStatus {
  double time = 0.0;
  std::int64_t steps = 0;
  std::string state;  // path of the first active atomic state
  double real_time_factor = 0.0;
  std::string note;  // what is to be known besides; mostly empty
};

class Reloads;
class RunLog;

// Where a run is in its steps.
struct StepClock {
  std::int64_t steps = 0;      // counted so far
  double last_step_at = 0.0;   // s
  double last_duration = 0.0;  // s; 0 before there are two
};

// Looks on while a run goes on, outside of the tick.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  // What acts on the robot from outside is done here.
  virtual void before_tick(const StepClock& steps, RunLog& log) = 0;
  // After compute(): signals and machine are those of this tick.
  virtual void after_tick() = 0;
};

struct RunSpec {
  std::int64_t max_steps = 0;                          // 0: no bound
  double max_time = 20.0;                              // s; 0: no bound
  std::optional<std::array<double, 2>> goal;           // m, world
  std::optional<std::array<double, 2>> goal_velocity;  // m/s, world; the goal moves from the start
  std::vector<ScheduledEvent> events;
  RunObserver* observer = nullptr;
  Reloads* reloads = nullptr;  // null: the behavior stays what it is
  bool realtime = false;       // paced by the wall clock
  engine::LogWriter* log = nullptr;
  engine::LivePort* live = nullptr;              // not started yet; stopped when the run ends
  const std::atomic<bool>* stop = nullptr;       // set by Ctrl-C
  std::function<void(const RunStatus&)> status;  // about five times a second of wall time
  // What a `log:` action or a script said, at its time, s; outside of the tick.
  std::function<void(double time, const std::string& text)> said;
  // Counts heap allocations of this thread while armed; null: not counted.
  void (*arm_allocations)(bool) = nullptr;
  std::int64_t (*allocations)() = nullptr;
};

struct RunResult {
  RunEnd end = RunEnd::time;
  std::optional<EndCause> cause;  // of a fall or a stop by a fault
  RunFigures figures;
  core::FaultCounters faults;
  std::string execution_error;    // the first one, with its place; empty: none
  std::int64_t marked_steps = 0;  // `mark: step` of the behavior; figures.steps are the feet's
  std::vector<WorstFault> worst;  // of the joints' faults, in the order of core::Fault
  core::TimingHistogram tick_time;
  std::int64_t allocations = -1;  // within ticks; -1: not counted
  double real_time_factor = 0.0;
  double wall_time = 0.0;
  int reloads = 0;                  // done, those taken back counted twice
  std::int64_t log_lost = 0;        // ticks that are not in the log
  std::vector<std::string> missed;  // scheduled events whose moment never came
  // Of optional ones, unless the run fell or was stopped by a fault: `push at 6.74 s`.
  std::vector<std::string> not_reached;
};

// Runs from start to end. Throws what engine::Executive::run() throws, and std::runtime_error if
// the goal is out of its range; the robot was stopped before.
RunResult run(engine::ControlLoop& loop, RunSpec& spec);

// The edits that spec.goal and spec.goal_velocity mean: the goal at once, then moving until the run
// or the goal's range ends. Empty if the behavior has no goal.
std::vector<engine::EditBatch> goal_edits(const behaviors::Behavior& behavior, const RunSpec& spec);

// Whether the behavior has a parameter that the goal options can move.
bool has_goal(const behaviors::Behavior& behavior);

}  // namespace footfall::lab
