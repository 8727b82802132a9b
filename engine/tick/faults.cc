// Counts faults and reacts to them; see faults.h.
#include "engine/tick/faults.h"

namespace footfall::engine {

using core::Fault;
using core::Reaction;

void FaultMonitor::begin_tick() noexcept {
  active_ = seen_;
  seen_ = {};
}

void FaultMonitor::take(const FaultFindings& findings, behaviors::Machine& machine) noexcept {
  if (!findings.any()) return;
  for (std::size_t f = 0; f < seen_.size(); ++f) {
    if (!findings.has(static_cast<Fault>(f))) continue;
    const FaultPlace& place = findings.place(static_cast<Fault>(f));
    FaultPlace& worst = worst_place_[f];
    if (place.joint >= 0 && (worst.joint < 0 || place.excess > worst.excess)) worst = place;
    if (!active_[f] && !seen_[f]) {
      counters_.add(static_cast<Fault>(f));
      last_place_[f] = place;
      react(static_cast<Fault>(f), machine);
    }
    if (!seen_[f]) counters_.add_tick(static_cast<Fault>(f));
    seen_[f] = true;
  }
}

void FaultMonitor::take_counts(behaviors::Machine& machine) noexcept {
  for (const Fault fault : {Fault::planner_late, Fault::execution, Fault::event_overflow}) {
    const auto index = static_cast<std::size_t>(fault);
    const std::int64_t count = machine.faults().count[index] - of_machine_.count[index];
    if (count == 0) continue;
    counters_.count[index] += count;
    counters_.add_tick(fault);
    react(fault, machine);
  }
  of_machine_ = machine.faults();
}

void FaultMonitor::take_late(bool late, behaviors::Machine& machine) noexcept {
  overruns_ = late ? overruns_ + 1 : 0;
  if (!late) return;
  counters_.add(Fault::tick_overrun);
  counters_.add_tick(Fault::tick_overrun);
  if (overruns_ == behavior_.robot.overruns) react(Fault::tick_overrun, machine);
}

bool FaultMonitor::is_grave(std::size_t fault) const noexcept {
  const auto which = static_cast<Fault>(fault);
  return which == Fault::fall || which == Fault::simulator_warning || which == Fault::execution ||
         behavior_.robot.reactions[fault] != Reaction::keep_going;
}

// A behavior without a safe state has nowhere to go on: its run stops.
Reaction FaultMonitor::reaction_to(Fault fault) const noexcept {
  const Reaction reaction = behavior_.robot.reactions[static_cast<std::size_t>(fault)];
  const bool nowhere = reaction == Reaction::safe_state && behavior_.safe_transition < 0;
  return nowhere ? Reaction::safe_stop : reaction;
}

void FaultMonitor::react(Fault fault, behaviors::Machine& machine) noexcept {
  if (probation_ && is_grave(static_cast<std::size_t>(fault))) {
    failed_by_ = fault;
    return;
  }
  const Reaction reaction = reaction_to(fault);
  machine.raise_fault(fault, reaction);
  const bool stops = reaction == Reaction::safe_stop;
  if (fault == Fault::fall || fault == Fault::simulator_warning ||
      (stops && fault == Fault::swing_too_long)) {
    if (state_ != LoopState::fallen) ended_by_ = fault;
    state_ = LoopState::fallen;
  } else if (stops && state_ == LoopState::running) {
    state_ = LoopState::stopped;
    ended_by_ = fault;
  }
}

void FaultMonitor::set_probation(bool on) noexcept {
  probation_ = on;
  failed_by_ = Fault::count;
}

void FaultMonitor::take_over(const FaultMonitor& old, bool forgive) noexcept {
  counters_ = old.counters_;
  of_machine_ = old.of_machine_;
  active_ = old.active_;
  seen_ = old.seen_;
  for (std::size_t f = 0; forgive && f < seen_.size(); ++f) seen_[f] = seen_[f] && !is_grave(f);
  last_place_ = old.last_place_;
  worst_place_ = old.worst_place_;
  ended_by_ = old.ended_by_;
  overruns_ = old.overruns_;
  failed_by_ = Fault::count;
  state_ = LoopState::running;
}

}  // namespace footfall::engine
