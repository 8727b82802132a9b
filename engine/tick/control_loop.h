// One control tick, in order: read, estimate, model, machine, whole-body control, safety, write.
// The same object runs over every backend; it knows no clock and creates no thread, so a lock-step
// simulation is repeatable bit for bit.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "behaviors/machine/machine.h"
#include "core/fault.h"
#include "core/signal_table.h"
#include "engine/edits/door.h"
#include "engine/links/hardware_link.h"
#include "engine/tick/faults.h"
#include "engine/tick/feet_watch.h"
#include "engine/tick/outside.h"
#include "engine/tick/rank_watch.h"
#include "engine/tick/safety.h"
#include "engine/tick/settings.h"
#include "engine/tick/signals.h"
#include "engine/watch/sensing.h"
#include "hal/hardware.h"
#include "model/control_model.h"
#include "tasks/whole_body_controller.h"

namespace footfall::engine {

// How values that differ come in force when a loop takes over.
enum class ValueChange : std::uint8_t {
  ramped,   // over the robot's time for edits
  at_once,  // back to what was known to be good
};

// The estimator finds no state at the start: why, in one sentence.
class NoState : public std::runtime_error {
 public:
  NoState(const std::string& why, bool markers) : runtime_error(why), markers_(markers) {}
  bool markers() const noexcept { return markers_; }  // motion capture saw too few

 private:
  bool markers_;
};

class ControlLoop {
 public:
  // Builds everything for the worst case. Throws std::runtime_error with one clear sentence
  // (model).
  ControlLoop(const behaviors::Behavior& behavior, hal::Hardware& hardware,
              const LoopSettings& settings);

  // Starts the hardware, reads it once and enters the behavior's initial state; once in a loop's
  // life (integrals, fault counters and parameters are those of one run). An estimator that needs
  // motion capture gets more reads, without commands in between, until a frame shows enough
  // markers: for the robot's limit mocap_age at most. Throws what the hardware throws, and NoState.
  void start();

  // The parts of a tick, so that a caller can time control apart from the backend. Allocate
  // nothing.
  bool sense() noexcept;    // hardware read; false: nothing new (a fault of compute())
  void compute() noexcept;  // estimate ... safety filter; commands are ready
  void actuate() noexcept;  // hardware write; the backend advances
  LoopState tick() noexcept;
  // Before sense() of a paced tick: whether it begins late. Late ticks are counted (tick.overrun);
  // as many in a row as the robot's `limits.overruns` have the fault's reaction.
  void late(bool late) noexcept { outside_.late(late); }

  LoopState state() const noexcept;
  std::int64_t ticks() const noexcept { return tick_; }
  double time() const noexcept { return static_cast<double>(tick_) * period_; }
  double period() const noexcept { return period_; }

  const behaviors::Behavior& behavior() const noexcept { return behavior_; }
  behaviors::Machine& machine() noexcept { return *machine_; }
  const behaviors::Machine& machine() const noexcept { return *machine_; }
  const model::ControlModel& model() const noexcept { return model_; }
  const tasks::WholeBodyController& controller() const noexcept { return controller_; }
  const core::SignalTable& signals() const noexcept { return signals_; }
  const hal::Sensors& sensors() const noexcept { return sensors_; }
  const hal::Commands& commands() const noexcept { return commands_; }
  const Estimate& estimate() const noexcept { return estimate_; }
  const core::FaultCounters& faults() const noexcept { return faults_.counters(); }
  // Where a fault appeared last, and where it was worst; joint -1: it is no joint's, or none yet.
  const FaultPlace& last_place(core::Fault fault) const noexcept {
    return faults_.last_place(fault);
  }
  const FaultPlace& worst_place(core::Fault fault) const noexcept {
    return faults_.worst_place(fault);
  }
  // The fault that made the state fallen or stopped; Fault::count: none did.
  core::Fault ended_by() const noexcept { return faults_.ended_by(); }
  // Live edits: submitted here, applied at the start of a tick.
  EditDoor& edits() noexcept { return edits_; }
  const EditDoor& edits() const noexcept { return edits_; }
  ScriptLink* scripts() noexcept { return outside_.scripts(); }  // nullptr: the behavior has none

  // While planners are dropped none of them answers: a fault to be tried on purpose.
  void drop_planners(bool on) noexcept { outside_.drop_planners(on); }
  // Before start(). What comes from outside in each tick goes to `trace`; it must outlive the loop.
  void record(InputTrace& trace) { outside_.record(trace); }
  // Before start(). Each tick takes what comes from outside from `trace`, which the caller fills
  // between ticks; planners' answers of its own are only told (InputTrace::planned). Scripts
  // must not run.
  void play(InputTrace& trace) { outside_.play(trace); }
  bool fresh() const noexcept { return fresh_; }  // whether the last sense() read something new

  // Between two ticks, instead of start(): goes on from where another loop over the same hardware
  // is, whose behavior's robot is the same (take_over.cc). Both must have been built before;
  // allocates nothing. Any number of times, each way. How values come in force: see
  // EditDoor::take_over.
  void take_over(ControlLoop& old, const behaviors::TakeOverMap& map, ValueChange change) noexcept;
  // Whether this loop may do that now: the old behavior permits it (`reload: ok`), its
  // configuration is one of this behavior's, and no contact transition is under way.
  bool may_take_over(const ControlLoop& old, const behaviors::TakeOverMap& map) const noexcept;
  // While it is on probation, a fault with a reaction is remembered and not reacted to; so is
  // error.execution. Whoever put the loop on probation asks before actuate().
  void set_probation(bool on) noexcept { faults_.set_probation(on); }
  core::Fault failed_by() const noexcept { return faults_.failed_by(); }  // Fault::count: none yet

  // Ends the run: the machine's safe state, then the hardware's safe stop.
  void safe_stop() noexcept;

 private:
  void find_state();

  const behaviors::Behavior& behavior_;
  hal::Hardware& hardware_;
  double period_;
  bool waits_;
  std::int64_t tick_ = 0;
  core::SignalTable signals_;
  model::ControlModel model_;
  std::unique_ptr<behaviors::Machine> machine_;
  EditDoor edits_;
  Sensing sensing_;
  tasks::WholeBodyController controller_;
  RankWatch ranks_;
  SwingWatch swings_;
  SlipWatch slips_;
  SafetyFilter safety_;
  FaultMonitor faults_;
  SignalWriter writer_;
  Outside outside_;
  HardwareLink link_;
  hal::Sensors sensors_;
  hal::Commands commands_;
  Estimate estimate_;
  bool fresh_ = true;  // the last sense() read something new
};

}  // namespace footfall::engine
