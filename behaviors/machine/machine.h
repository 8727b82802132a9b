// The statechart at run time together with the control that it selects: one tick() in the realtime
// loop, between the model update and the whole-body controller. Allocates nothing after
// construction.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "behaviors/statechart/execution_problem.h"
#include "behaviors/statechart/statechart.h"
#include "core/fault.h"
#include "core/signal_table.h"
#include "model/control_model.h"
#include "model/height_surface.h"
#include "tasks/active_set.h"

namespace footfall::behaviors {

struct TakeOverMap;

// A request by an `invoke` in this tick.
struct PlanRequest {
  int planner = 0;             // index into Behavior::planners
  std::uint32_t sequence = 0;  // incremented with each request; an exit cancels all older ones
  int stance = -1;             // contact indices
  int swing = -1;
  double switch_in = 0.0;  // s until the support changes, counted from now
  FootPlannerInput input;  // of the tick that asks
};

// A planner's answer.
struct PlanAnswer {
  int planner = 0;
  std::uint32_t sequence = 0;
  bool ok = false;
  std::array<double, 3> target{};         // m, world
  std::array<double, 2> predicted_pos{};  // m, world
  std::array<double, 2> predicted_vel{};  // m/s, world
  double extension = 0.0;                 // s
};

class Machine {
 public:
  // `signals` is the run's table (values are read each tick and planner rows written), laid out by
  // behavior.layout. `model`, updated before each tick, gives what tasks measure, where references
  // start; nullptr: no robot, every task measures 0. All must outlive the machine.
  Machine(const Behavior& behavior, core::SignalTable& signals,
          const model::ControlModel* model = nullptr);
  ~Machine();

  // The world's walking surface, flat by default; set before start().
  void set_surface(const model::HeightSurface& surface);

  // Enters the initial configuration at tick 0; signals hold the first measurement.
  void start() noexcept;
  // One macro step (docs/behaviors.md 8.3), then references of the active control.
  // `tick` counts control periods since start (skipped ones included).
  void tick(std::int64_t tick) noexcept;

  // Bumpless transfer from the machine of another behavior, between two ticks and instead of
  // start(): continues with its configuration and clocks (Statechart::take_over), references,
  // parameter values and waiting events. The signals contain its last values. Can be repeated in
  // both directions.
  void take_over(const Machine& old, const TakeOverMap& map) noexcept;
  // Whether its configuration exists in this behavior.
  bool has_configuration_of(const Machine& old, const TakeOverMap& map) const noexcept;

  const tasks::ActiveControl& control() const noexcept;
  int control_spec() const noexcept;  // of its primary law: index into Behavior::controls
  bool stepping() const noexcept;     // the behavior has marked a step
  bool finished() const noexcept;     // a final child of the root was entered

  // Raises an external event by id (Behavior::find_event); false: the queue is full (counted,
  // raised).
  bool raise(int event) noexcept;
  std::size_t outside_room() const noexcept;  // free places before the next tick
  // Copies the external events waiting for the next tick, in order, to the end of `events`, as far
  // as it has room.
  void copy_outside_events(std::vector<int>& events) const noexcept;
  // Fault events `fault.NAME`; with reaction safe_state the `safe` state is entered at this tick.
  void raise_fault(core::Fault fault, core::Reaction reaction) noexcept;
  void enter_safe() noexcept;  // docs/behaviors.md 8.10

  // Requests of this tick (valid until the next tick) and answers to earlier ones.
  std::span<const PlanRequest> plan_requests() const noexcept;
  void deliver(const PlanAnswer& answer) noexcept;

  // Parameters and gains, flat; edits are written here between two ticks.
  std::span<double> parameters() noexcept;
  std::span<const double> parameters() const noexcept;

  // Active atomic states in document order; marks (indices into Behavior::marks) of this tick;
  // transitions (indices into Behavior::transitions) taken in this tick.
  std::span<const int> active_atomic() const noexcept;
  std::span<const int> active_states() const noexcept;
  std::span<const int> marks() const noexcept;
  std::span<const int> transitions_taken() const noexcept;
  // Events processed in this tick, in order.
  std::span<const int> events_taken() const noexcept;
  // Texts logged in this tick; their pieces and fields are in Behavior::logs.
  std::span<const LogRecord> logs() const noexcept;
  // Requests to scripts in this tick, in order (indices into Behavior::calls and events).
  std::span<const ScriptRequest> script_requests() const noexcept;
  bool is_active(int state) const noexcept;
  // Number of entries of a state so far, and values of a transition's guard: bit 0 false, bit 1
  // true.
  std::uint32_t entries(int state) const noexcept;
  std::uint8_t guard_outcomes(int transition) const noexcept;
  // The tick at which a transition's `after` expires; -1: none, or already taken.
  std::int64_t deadline(int transition) const noexcept;
  // Current inputs of expressions over states, parameters and time.
  const EvaluationContext& context() const noexcept;
  const core::FaultCounters& faults() const noexcept;
  // Why error.execution was raised: the first problem of the last tick that had one.
  const ExecutionProblem& execution_problem() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::behaviors
