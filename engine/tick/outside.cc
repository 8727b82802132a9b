// Deliveries and posts of one tick, recorded or replayed; see outside.h.
#include "engine/tick/outside.h"

#include <cmath>

namespace footfall::engine {
namespace {

int latency_ticks(double latency, double period) {
  return static_cast<int>(std::ceil(latency / period - 1e-9));
}

std::unique_ptr<ScriptLink> make_scripts(const behaviors::Behavior& behavior,
                                         const LoopSettings& settings) {
  if (behavior.scripts.empty() || !settings.run_scripts) return nullptr;
  behaviors::ScriptSettings script;
  script.access = settings.script_access;
  script.seed = settings.seed;
  script.limits = behavior.script_limits;
  return std::make_unique<ScriptLink>(behavior, script, !settings.lockstep);
}

}  // namespace

Outside::Outside(const behaviors::Behavior& behavior, const LoopSettings& settings)
    : behavior_(behavior),
      planners_(behavior, latency_ticks(settings.planner_latency, behavior.robot.period_s())),
      scripts_(make_scripts(behavior, settings)),
      lockstep_(settings.lockstep),
      watch_(behavior) {}

void Outside::record(InputTrace& trace) {
  trace.size_for(behavior_);
  trace_ = &trace;
}

void Outside::play(InputTrace& trace) {
  record(trace);
  playing_ = true;
}

void Outside::start(const behaviors::Machine& machine) noexcept {
  watch_.remember(machine.parameters());
}

bool Outside::deliver(std::int64_t tick, behaviors::Machine& machine, bool edited) noexcept {
  limit_steps_ = playing_ ? trace_->limit_steps : edited || taken_over_;
  const bool late = playing_ ? trace_->late : late_;
  late_ = taken_over_ = false;
  if (playing_) {
    replay(tick, machine);
    return late;
  }
  if (trace_ != nullptr) {
    trace_->clear();
    trace_->limit_steps = limit_steps_;
    trace_->late = late;
  }
  planners_.deliver(tick, machine, trace_ != nullptr ? &trace_->plans : nullptr);
  if (scripts_) scripts_->deliver(machine);
  if (trace_ != nullptr) {
    watch_.find(machine.parameters(), trace_->writes);
    machine.copy_outside_events(trace_->events);
  }
  return late;
}

void Outside::replay(std::int64_t tick, behaviors::Machine& machine) noexcept {
  trace_->planned.clear();
  planners_.deliver(tick, machine, &trace_->planned, false);
  for (const behaviors::PlanAnswer& plan : trace_->plans) machine.deliver(plan);
  for (const behaviors::SlotValue& write : trace_->writes) {
    machine.parameters()[static_cast<std::size_t>(write.slot)] = write.value;
  }
  for (const int event : trace_->events) machine.raise(event);
  if (trace_->inspect) trace_->inspect();
}

FaultFindings Outside::post(std::int64_t tick, const behaviors::Machine& machine,
                            const core::SignalTable& signals, double time) noexcept {
  FaultFindings findings;
  if (trace_ != nullptr) watch_.remember(machine.parameters());
  planners_.post(tick, machine);
  const bool lost = playing_ ? trace_->requests_lost
                             : scripts_ && !scripts_->post(machine, signals.values(), time);
  if (lost) findings.add(core::Fault::event_overflow);
  const bool stuck =
      playing_ ? trace_->scripts_stuck : scripts_ && scripts_->stuck(behavior_.robot.period_s());
  if (stuck) findings.add(core::Fault::script_stuck);
  if (trace_ != nullptr) {
    trace_->requests_lost = lost;
    trace_->scripts_stuck = stuck;
  }
  return findings;
}

void Outside::wait() noexcept {
  if (scripts_ && lockstep_) scripts_->wait();
}

void Outside::take_over(const Outside& old, const behaviors::Machine& machine) noexcept {
  planners_.take_over(old.planners_);
  limit_steps_ = old.limit_steps_;
  late_ = old.late_;  // of the tick to come
  taken_over_ = true;
  watch_.remember(machine.parameters());
}

}  // namespace footfall::engine
