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
  if (!findings.any) return;
  for (std::size_t f = 0; f < seen_.size(); ++f) {
    if (!findings.found[f]) continue;
    const FaultPlace& place = findings.place[f];
    FaultPlace& worst = worst_place_[f];
    if (place.joint >= 0 && (worst.joint < 0 || place.excess > worst.excess)) worst = place;
    if (!active_[f] && !seen_[f]) {
      counters_.add(static_cast<Fault>(f));
      last_place_[f] = place;
      react(static_cast<Fault>(f), machine);
    }
    seen_[f] = true;
  }
}

void FaultMonitor::take_counts(behaviors::Machine& machine) noexcept {
  if (probation_ && machine.faults().of(Fault::execution) > of_machine_.of(Fault::execution)) {
    failed_by_ = Fault::execution;
  }
  of_machine_ = machine.faults();
}

bool FaultMonitor::is_grave(std::size_t fault) const noexcept {
  const auto which = static_cast<Fault>(fault);
  return which == Fault::fall || which == Fault::simulator_warning ||
         behavior_.robot.reactions[fault] != Reaction::keep_going;
}

void FaultMonitor::react(Fault fault, behaviors::Machine& machine) noexcept {
  const auto index = static_cast<std::size_t>(fault);
  if (probation_ && is_grave(index)) {
    failed_by_ = fault;
    return;
  }
  const Reaction reaction = behavior_.robot.reactions[index];
  machine.raise_fault(fault, reaction);
  if (fault == Fault::fall || fault == Fault::simulator_warning) {
    if (state_ != LoopState::fallen) ended_by_ = fault;
    state_ = LoopState::fallen;
  } else if (reaction == Reaction::safe_stop && state_ == LoopState::running) {
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
  failed_by_ = Fault::count;
  state_ = LoopState::running;
}

}  // namespace footfall::engine
