// One control tick, in order: read, estimate, model, machine, whole-body control, safety, write.
// The same object runs over every backend; it knows no clock and creates no thread, so a lock-step
// simulation is repeatable bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "behaviors/machine/machine.h"
#include "core/fault.h"
#include "core/signal_table.h"
#include "engine/edits/door.h"
#include "engine/estimators/catalogue.h"
#include "engine/tick/input_trace.h"
#include "engine/tick/planner_link.h"
#include "engine/tick/safety.h"
#include "engine/tick/script_link.h"
#include "hal/hardware.h"
#include "model/control_model.h"
#include "model/height_surface.h"
#include "tasks/whole_body_controller.h"

namespace footfall::engine {

struct LoopSettings {
  std::string_view estimator = kDefaultEstimator;  // by name, of the catalogue
  model::ModelDeviation deviation;                 // of the control model from the robot file
  double planner_latency = 2e-3;                   // s, lock-step
  bool lockstep = true;  // the caller's clock waits for what other threads compute
  behaviors::ScriptAccess script_access;
  bool run_scripts = true;       // false: a replay, which has their answers
  std::uint64_t seed = 0;        // of the scripts' random numbers
  model::HeightSurface surface;  // of the world, for references that follow it
};

// How values that differ come in force when a loop takes over.
enum class ValueChange : std::uint8_t {
  ramped,   // over the robot's time for edits
  at_once,  // back to what was known to be good
};

enum class LoopState : std::uint8_t {
  running,
  finished,  // the behavior reached a final state of its root
  fallen,
  stopped,  // a fault whose reaction is safe_stop
};

class ControlLoop {
 public:
  // Builds everything for the worst case. Throws std::runtime_error with one clear sentence
  // (model).
  ControlLoop(const behaviors::Behavior& behavior, hal::Hardware& hardware,
              const LoopSettings& settings);

  // Starts the hardware, reads it once and enters the behavior's initial state; once in a loop's
  // life (integrals, fault counters and parameters are those of one run). May throw.
  void start();

  // The tick in two halves, so that a caller can time control apart from the backend:
  // sense() reads the hardware; control() computes and writes. Allocate nothing.
  bool sense() noexcept;    // false: nothing new was read (counted; control() still runs)
  void compute() noexcept;  // estimate ... safety filter; commands are ready
  void actuate() noexcept;  // hardware write; the backend advances
  LoopState tick() noexcept;
  // Before sense() of a paced tick: whether it begins late. Late ticks are counted (tick.overrun);
  // as many in a row as the robot's `limits.overruns` have the fault's reaction.
  void late(bool late) noexcept;

  LoopState state() const noexcept { return state_; }
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
  const core::FaultCounters& faults() const noexcept { return faults_; }
  // Where a fault appeared last, and where it was worst; joint -1: it is no joint's, or none yet.
  const FaultPlace& last_place(core::Fault fault) const noexcept {
    return last_place_[static_cast<std::size_t>(fault)];
  }
  const FaultPlace& worst_place(core::Fault fault) const noexcept {
    return worst_place_[static_cast<std::size_t>(fault)];
  }
  // The fault that made the state fallen or stopped; Fault::count: none did.
  core::Fault ended_by() const noexcept { return ended_by_; }
  // Live edits: submitted here, applied at the start of a tick.
  EditDoor& edits() noexcept { return edits_; }
  const EditDoor& edits() const noexcept { return edits_; }
  ScriptLink* scripts() noexcept { return scripts_.get(); }  // nullptr: the behavior has none

  // While planners are dropped none of them answers: a fault to be tried on purpose.
  void drop_planners(bool on) noexcept { planners_.drop(on); }
  // Before start(). What comes from outside in each tick goes to `trace`; it must outlive the loop.
  void record(InputTrace& trace);
  // Before start(). Each tick takes what comes from outside from `trace`, which the caller fills
  // between ticks; planners' answers of its own are only told (InputTrace::planned). Scripts
  // must not run.
  void play(InputTrace& trace);
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
  void set_probation(bool on) noexcept;
  core::Fault failed_by() const noexcept { return failed_by_; }  // Fault::count: none yet

  // Ends the run: the machine's safe state, then the hardware's safe stop.
  void safe_stop() noexcept;

 private:
  class LoopMeasure final : public behaviors::Measure {
   public:
    explicit LoopMeasure(const model::ControlModel& model) : model_(model) {}
    double position(tasks::TaskType type, int point, int axis) const noexcept override {
      return tasks::measured_position(model_, type, point, axis);
    }
    double velocity(tasks::TaskType type, int point, int axis) const noexcept override {
      return tasks::measured_velocity(model_, type, point, axis);
    }

   private:
    const model::ControlModel& model_;
  };

  void handle(const SafetyFindings& findings) noexcept;
  bool is_grave(std::size_t fault) const noexcept;  // it ends the run or has a reaction
  void take_signals(const ControlLoop& old, const behaviors::TakeOverMap& map) noexcept;
  void react(core::Fault fault) noexcept;
  void observe_support() noexcept;
  void write_measured_signals() noexcept;
  void write_control_signals() noexcept;
  void write_task_signals() noexcept;
  void write_internal_signals() noexcept;
  void leave_gaps() noexcept;
  void take_inputs() noexcept;
  bool is_edited() const noexcept;

  const behaviors::Behavior& behavior_;
  hal::Hardware& hardware_;
  double period_;
  core::SignalTable signals_;
  model::ControlModel model_;
  std::unique_ptr<behaviors::Machine> machine_;
  EditDoor edits_;
  tasks::WholeBodyController controller_;
  std::unique_ptr<Estimator> estimator_;
  PlannerLink planners_;
  std::unique_ptr<ScriptLink> scripts_;
  bool lockstep_;
  SafetyFilter safety_;
  LoopMeasure measure_;
  hal::Sensors sensors_;
  hal::Commands commands_;
  model::State estimate_;
  core::FaultCounters faults_;
  std::vector<std::vector<int>> axis_column_;  // by task name and axis: column of its signals, -1
  // Signals of the tasks and internal forces that were in force in the last tick: NaN when they go.
  std::vector<std::vector<int>> task_rows_, internal_rows_;  // by name: indices of their signals
  std::vector<unsigned char> task_in_force_, internal_in_force_;
  std::array<bool, core::kFaultCount> active_{};  // faults present in the previous tick
  std::array<bool, core::kFaultCount> seen_{};    // faults present in this one so far
  std::array<FaultPlace, core::kFaultCount> last_place_{}, worst_place_{};
  core::Fault ended_by_ = core::Fault::count;
  core::Fault failed_by_ = core::Fault::count;
  bool probation_ = false;
  int overruns_ = 0;                      // late ticks in a row
  bool fresh_ = true, was_fresh_ = true;  // new sensor data in this tick, in the previous
  WriteWatch watch_;
  InputTrace* trace_ = nullptr;
  bool playing_ = false;
  bool taken_over_ = false;   // since the last tick
  bool limit_steps_ = false;  // in this tick: an edit acts on the command
  std::int64_t tick_ = 0;
  LoopState state_ = LoopState::running;
};

// Capacities that a behavior needs at worst, for the whole-body controller.
tasks::ControllerSizes controller_sizes(const behaviors::Behavior& behavior);

}  // namespace footfall::engine
