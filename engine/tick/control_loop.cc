// The tick; see control_loop.h.
#include "engine/tick/control_loop.h"

#include <algorithm>
#include <cmath>

namespace footfall::engine {
namespace {

std::vector<double> torque_limits(const model::RobotDescription& robot) {
  std::vector<double> limits;
  for (const model::JointDescription& joint : robot.joints) {
    // An actuator without a stated limit is limited by the backend alone.
    limits.push_back(joint.torque_limit > 0.0 ? joint.torque_limit : 1e9);
  }
  return limits;
}

// Where the signals of a task's axis are: tasks of one name list only the axes they use, by name.
std::vector<std::vector<int>> axis_columns(const behaviors::Behavior& behavior) {
  std::vector<std::vector<int>> columns(behavior.task_names.size());
  for (const behaviors::TaskInstance& task : behavior.task_instances) {
    const auto index = static_cast<std::size_t>(task.signals);
    const std::vector<std::string>& used = behavior.task_names[index].axes;
    columns[index].clear();
    for (const std::string& name : tasks::axis_names(task.type, behavior.robot)) {
      const auto found = std::find(used.begin(), used.end(), name);
      columns[index].push_back(found == used.end() ? -1 : static_cast<int>(found - used.begin()));
    }
  }
  return columns;
}

// All signals of a task or internal force, by name.
std::vector<std::vector<int>> rows_of(const behaviors::Behavior& behavior, const std::string& kind,
                                      const std::vector<std::string>& names) {
  std::vector<std::vector<int>> rows;
  for (const std::string& name : names) {
    std::vector<int>& own = rows.emplace_back();
    const std::string prefix = kind + "." + name + ".";
    for (int s = 0; s < behavior.signals.size(); ++s) {
      if (behavior.signals.info(s).name.starts_with(prefix)) own.push_back(s);
    }
  }
  return rows;
}

std::vector<std::string> task_names(const behaviors::Behavior& behavior) {
  std::vector<std::string> names;
  for (const behaviors::TaskName& task : behavior.task_names) names.push_back(task.name);
  return names;
}

int latency_ticks(double latency, double period) {
  return static_cast<int>(std::ceil(latency / period - 1e-9));
}

std::unique_ptr<ScriptLink> make_scripts(const behaviors::Behavior& behavior,
                                         const LoopSettings& settings) {
  if (behavior.scripts.empty() || !settings.run_scripts) return nullptr;
  behaviors::ScriptSettings script;
  script.access = settings.script_access;
  script.seed = settings.seed;
  if (behavior.script_instructions > 0) script.instructions = behavior.script_instructions;
  return std::make_unique<ScriptLink>(behavior, script);
}

}  // namespace

tasks::ControllerSizes controller_sizes(const behaviors::Behavior& behavior) {
  tasks::ControllerSizes sizes;
  sizes.task_instances = std::max<int>(1, static_cast<int>(behavior.task_instances.size()));
  sizes.contacts = std::max<int>(1, static_cast<int>(behavior.robot.contacts.size()));
  sizes.task_rows = 0;
  for (const behaviors::TaskInstance& task : behavior.task_instances) {
    sizes.task_rows += tasks::info(task.type).axis_count(behavior.robot.joint_count());
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
      machine_(std::make_unique<behaviors::Machine>(behavior, signals_)),
      edits_(behavior),
      controller_(model_, torque_limits(behavior.robot), controller_sizes(behavior), period_),
      estimator_(make_estimator(settings.estimator, behavior.robot)),
      planners_(behavior, model_, latency_ticks(settings.planner_latency, period_)),
      scripts_(make_scripts(behavior, settings)),
      lockstep_(settings.lockstep),
      safety_(behavior.robot),
      measure_(model_),
      axis_column_(axis_columns(behavior)),
      task_rows_(rows_of(behavior, "task", task_names(behavior))),
      internal_rows_(rows_of(behavior, "internal", behavior.internal_instances)),
      task_in_force_(task_rows_.size(), 1),
      internal_in_force_(internal_rows_.size(), 1),
      watch_(behavior) {
  machine_->set_surface(settings.surface);
}

void ControlLoop::start() {
  hardware_.start();
  tick_ = 0;
  state_ = LoopState::running;
  sense();
  estimator_->estimate(sensors_, estimate_);
  model_.update(estimate_);
  planners_.start();
  write_measured_signals();
  leave_gaps();
  machine_->start(measure_);
  watch_.remember(machine_->parameters());
}

LoopState ControlLoop::tick() noexcept {
  sense();
  compute();
  actuate();
  return state_;
}

void ControlLoop::late(bool late) noexcept {
  overruns_ = late ? overruns_ + 1 : 0;
  if (!late) return;
  faults_.add(core::Fault::tick_overrun);
  if (overruns_ == behavior_.robot.overruns) react(core::Fault::tick_overrun);
}

bool ControlLoop::sense() noexcept {
  if (scripts_ && lockstep_) scripts_->wait();
  fresh_ = hardware_.read(sensors_);
  if (!fresh_) faults_.add(core::Fault::sensor_stale);
  return fresh_;
}

void ControlLoop::record(InputTrace& trace) {
  trace.size_for(behavior_);
  trace_ = &trace;
}

void ControlLoop::play(InputTrace& trace) {
  record(trace);
  playing_ = true;
}

void ControlLoop::compute() noexcept {
  edits_.apply(tick_, *machine_);
  estimator_->estimate(sensors_, estimate_);
  model_.update(estimate_);
  write_measured_signals();
  handle(safety_.check_state(sensors_, model_));
  if (!fresh_ && was_fresh_) react(core::Fault::sensor_stale);  // counted where it was read
  was_fresh_ = fresh_;
  take_inputs();
  const std::int64_t errors = machine_->faults().of(core::Fault::execution);
  machine_->tick(tick_, measure_);
  if (machine_->faults().of(core::Fault::execution) > errors && probation_) {
    failed_by_ = core::Fault::execution;
  }
  if (trace_ != nullptr) watch_.remember(machine_->parameters());
  observe_support();
  planners_.take(tick_, *machine_);
  if (scripts_ && !scripts_->post(*machine_, signals_.values(), time())) {
    faults_.add(core::Fault::event_overflow);
  }
  controller_.compute(machine_->control(), tick_, sensors_.tau.data());
  std::copy_n(controller_.result().tau.begin(), model_.joint_count(), commands_.tau.begin());
  handle(safety_.filter(commands_, limit_steps_));
  active_ = seen_;
  seen_ = {};
  write_control_signals();
  if (state_ == LoopState::running && machine_->finished()) state_ = LoopState::finished;
}

void ControlLoop::actuate() noexcept {
  hardware_.write(commands_);
  ++tick_;
}

// What comes from outside of the tick, as it arrives now or, in a replay, as it was logged.
void ControlLoop::take_inputs() noexcept {
  limit_steps_ = playing_ ? trace_->limit_steps : is_edited();
  taken_over_ = false;
  if (trace_ == nullptr) {
    planners_.deliver(tick_, *machine_, nullptr);
    if (scripts_) scripts_->deliver(*machine_);
  } else if (playing_) {
    trace_->planned.clear();
    planners_.deliver(tick_, *machine_, &trace_->planned, false);
    for (const behaviors::PlanAnswer& plan : trace_->plans) machine_->deliver(plan);
    for (const behaviors::SlotValue& write : trace_->writes) {
      machine_->parameters()[static_cast<std::size_t>(write.slot)] = write.value;
    }
    for (const int event : trace_->events) machine_->raise(event);
    if (trace_->inspect) trace_->inspect();
  } else {
    trace_->clear();
    trace_->limit_steps = limit_steps_;
    planners_.deliver(tick_, *machine_, &trace_->plans);
    if (scripts_) scripts_->deliver(*machine_);
    watch_.find(machine_->parameters(), trace_->writes);
    machine_->copy_outside_events(trace_->events);
  }
}

// Whether an edit moves values in this tick or a behavior took over before it, or the command has
// not caught up with one yet.
bool ControlLoop::is_edited() const noexcept {
  return edits_.moved() || taken_over_ || (limit_steps_ && safety_.held_back());
}

// A fault is counted and raised when it appears; it must go away before it counts again.
void ControlLoop::handle(const SafetyFindings& findings) noexcept {
  for (int i = 0; i < core::kFaultCount; ++i) {
    const auto fault = static_cast<core::Fault>(i);
    const auto index = static_cast<std::size_t>(i);
    const bool mine = findings.found[index];
    const FaultPlace& place = findings.place[index];
    FaultPlace& worst = worst_place_[index];
    if (place.joint >= 0 && (worst.joint < 0 || place.excess > worst.excess)) worst = place;
    if (mine && !active_[index]) {
      faults_.add(fault);
      last_place_[index] = place;
      react(fault);
    }
    seen_[index] |= mine;
  }
}

bool ControlLoop::is_grave(std::size_t fault) const noexcept {
  const auto which = static_cast<core::Fault>(fault);
  return which == core::Fault::fall || which == core::Fault::simulator_warning ||
         behavior_.robot.reactions[fault] != core::Reaction::keep_going;
}

void ControlLoop::react(core::Fault fault) noexcept {
  const core::Reaction reaction = behavior_.robot.reactions[static_cast<std::size_t>(fault)];
  if (probation_ && is_grave(static_cast<std::size_t>(fault))) {
    failed_by_ = fault;
    return;
  }
  machine_->raise_fault(fault, reaction);
  if (fault == core::Fault::fall || fault == core::Fault::simulator_warning) {
    if (state_ != LoopState::fallen) ended_by_ = fault;
    state_ = LoopState::fallen;
  } else if (reaction == core::Reaction::safe_stop && state_ == LoopState::running) {
    state_ = LoopState::stopped;
    ended_by_ = fault;
  }
}

void ControlLoop::observe_support() noexcept {
  const tasks::ControlSet& set = machine_->control().primary;
  planners_.observe({set.contacts.data(), static_cast<std::size_t>(set.contact_count)},
                    machine_->parameters(), period_);
}

void ControlLoop::safe_stop() noexcept {
  machine_->enter_safe();
  hardware_.safe_stop();
}

}  // namespace footfall::engine
