// The tick; see control_loop.h.
#include "engine/tick/control_loop.h"

#include <algorithm>

namespace footfall::engine {

tasks::ControllerSizes controller_sizes(const behaviors::Behavior& behavior) {
  tasks::ControllerSizes sizes;
  sizes.task_instances = std::max<int>(1, static_cast<int>(behavior.task_instances.size()));
  sizes.contacts = std::max<int>(1, static_cast<int>(behavior.robot.contacts.size()));
  sizes.task_rows = 0;
  for (const behaviors::TaskInstance& task : behavior.task_instances) {
    sizes.task_rows += tasks::axis_capacity(task.type, behavior.robot.joint_count());
  }
  sizes.task_rows = std::clamp(sizes.task_rows, 1, core::kMaxAxes);
  sizes.levels = std::max(1, sizes.task_instances);
  return sizes;
}

ControlLoop::ControlLoop(const behaviors::Behavior& behavior, hal::Hardware& hardware,
                         const LoopSettings& settings)
    : behavior_(behavior),
      hardware_(hardware),
      period_(behavior.robot.period_s()),
      signals_(behavior.signals),
      model_(behavior.robot, settings.deviation),
      machine_(std::make_unique<behaviors::Machine>(behavior, signals_, &model_)),
      edits_(behavior),
      estimator_(behavior.robot.joint_count()),
      controller_(model_, behavior.robot.torque_limits(), controller_sizes(behavior), period_),
      safety_(behavior.robot),
      faults_(behavior),
      writer_(behavior, signals_),
      outside_(behavior, settings) {
  machine_->set_surface(settings.surface);
}

void ControlLoop::start() {
  hardware_.start();
  sense();
  estimator_.estimate(sensors_, estimate_);
  model_.update(estimate_);
  writer_.write_measured(time(), model_, sensors_);
  writer_.leave_gaps();
  machine_->start();
  outside_.start(*machine_);
}

LoopState ControlLoop::tick() noexcept {
  sense();
  compute();
  actuate();
  return state();
}

bool ControlLoop::sense() noexcept {
  outside_.wait();
  fresh_ = hardware_.read(sensors_);
  return fresh_;
}

void ControlLoop::compute() noexcept {
  faults_.begin_tick();
  edits_.apply(tick_, *machine_);
  estimator_.estimate(sensors_, estimate_);
  model_.update(estimate_);
  writer_.write_measured(time(), model_, sensors_);
  faults_.take(safety_.check_state(sensors_, fresh_, model_), *machine_);
  outside_.deliver(tick_, *machine_, edits_.moved() || safety_.held_back());
  machine_->tick(tick_);
  faults_.take_counts(*machine_);
  faults_.take(outside_.post(tick_, *machine_, signals_, time()), *machine_);
  controller_.compute(machine_->control(), tick_, sensors_.tau.data(), commands_.tau.data());
  faults_.take(safety_.filter(commands_, outside_.limit_steps()), *machine_);
  writer_.write_control(*machine_, controller_.result(), commands_, safety_.torque_step(),
                        faults_.counters());
}

void ControlLoop::actuate() noexcept {
  hardware_.write(commands_);
  ++tick_;
}

LoopState ControlLoop::state() const noexcept {
  if (faults_.state() == LoopState::running && machine_->finished()) return LoopState::finished;
  return faults_.state();
}

void ControlLoop::safe_stop() noexcept {
  machine_->enter_safe();
  hardware_.safe_stop();
}

}  // namespace footfall::engine
