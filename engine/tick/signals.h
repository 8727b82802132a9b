// Writes the signal table of a tick: measured values before the machine, control after it. Signals
// of tasks and internal forces that are not in force are NaN: gaps in the log, false in conditions.
#pragma once

#include <vector>

#include "behaviors/machine/machine.h"
#include "core/fault.h"
#include "core/signal_table.h"
#include "engine/estimators/estimator.h"
#include "hal/hardware.h"
#include "model/control_model.h"
#include "tasks/whole_body_controller.h"

namespace footfall::behaviors {
struct TakeOverMap;
}

namespace footfall::engine {

class SignalWriter {
 public:
  // `signals` is laid out by behavior.layout. Both must outlive this.
  SignalWriter(const behaviors::Behavior& behavior, core::SignalTable& signals);

  // time: s since start.
  void write_measured(double time, const model::ControlModel& model, const hal::Sensors& sensors,
                      const Estimate& estimate) noexcept;
  // torque_step: N m, largest of this tick.
  void write_control(const behaviors::Machine& machine, const tasks::ControllerResult& result,
                     const hal::Commands& commands, double torque_step,
                     const core::FaultCounters& counters) noexcept;
  // NaN for all that was in force.
  void leave_gaps() noexcept;
  // The last values of another behavior's signals, by name; what it has not is NaN.
  void take_over(const SignalWriter& old, const behaviors::TakeOverMap& map) noexcept;

 private:
  void write_quality(const EstimateQuality& quality) noexcept;
  void write_truth(const model::ControlModel& model, const hal::Sensors& sensors) noexcept;
  void write_internals(const tasks::ControlSet& set,
                       const tasks::ControllerResult& result) noexcept;
  void write_tasks(const tasks::ControlSet& set, const tasks::ControllerResult& result) noexcept;

  const behaviors::Behavior& behavior_;
  core::SignalTable& signals_;
  std::vector<std::vector<int>> axis_column_;  // by task name and axis: column of its signals, -1
  std::vector<std::vector<int>> task_rows_, internal_rows_;  // by name: indices of their signals
  // Those that the law in force has.
  std::vector<unsigned char> task_in_force_, internal_in_force_;
  int control_ = -1;  // index of that law; -1: of another loop, or none yet
};

}  // namespace footfall::engine
