// A control loop in another's place, between two ticks; see ControlLoop::take_over.
#include <algorithm>
#include <bit>
#include <cmath>

#include "behaviors/compiled/take_over_map.h"
#include "core/index.h"
#include "engine/tick/control_loop.h"

namespace footfall::engine {
namespace {

bool same_bits(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

bool ControlLoop::may_take_over(const ControlLoop& old,
                                const behaviors::TakeOverMap& map) const noexcept {
  if (old.state_ != LoopState::running || old.machine_->finished()) return false;
  if (old.machine_->control().has_other) return false;
  for (const int s : old.machine_->active_atomic()) {
    if (!behaviors::permits_reload(old.behavior_, s)) return false;
  }
  return machine_->has_configuration_of(*old.machine_, map);
}

void ControlLoop::take_over(ControlLoop& old, const behaviors::TakeOverMap& map,
                            ValueChange change) noexcept {
  tick_ = old.tick_;
  state_ = LoopState::running;
  sensors_ = old.sensors_;
  commands_ = old.commands_;
  estimate_ = old.estimate_;
  faults_ = old.faults_;
  active_ = old.active_;
  if (change == ValueChange::at_once) {  // what brought it back is to be reacted to, if it stays
    for (std::size_t f = 0; f < active_.size(); ++f) active_[f] = active_[f] && !is_grave(f);
  }
  seen_ = old.seen_;
  last_place_ = old.last_place_;
  worst_place_ = old.worst_place_;
  ended_by_ = old.ended_by_;
  fresh_ = old.fresh_;
  was_fresh_ = old.was_fresh_;
  failed_by_ = core::Fault::count;
  limit_steps_ = old.limit_steps_;
  taken_over_ = true;
  safety_.take_over(old.safety_);
  take_signals(old, map);
  const bool ramped = change == ValueChange::ramped;
  const std::int64_t periods =
      ramped ? behaviors::periods_of(behavior_.robot.edit_ramp, behavior_.rate_mhz) : 0;
  edits_.take_over(old.edits_, {old.behavior_, behavior_, map, old.machine_->parameters(),
                                machine_->parameters(), tick_, periods});
  if (playing_) edits_.rest();
  machine_->take_over(*old.machine_, map);
  controller_.take_over(old.controller_, map.instances);
  planners_.take_over(old.planners_, map.planners, old.model_);
  watch_.remember(machine_->parameters());
}

// By name; what the old behavior has not, is not in force yet.
void ControlLoop::take_signals(const ControlLoop& old, const behaviors::TakeOverMap& map) noexcept {
  for (auto* in_force : {&task_in_force_, &internal_in_force_}) {
    std::ranges::fill(*in_force, static_cast<unsigned char>(1));
  }
  leave_gaps();
  for (std::size_t s = 0; s < map.signals.size(); ++s) {
    if (map.signals[s] >= 0) signals_[map.signals[s]] = old.signals_.values()[s];
  }
  for (auto* in_force : {&task_in_force_, &internal_in_force_}) {
    std::ranges::fill(*in_force, static_cast<unsigned char>(1));
  }
}

void ControlLoop::set_probation(bool on) noexcept {
  probation_ = on;
  failed_by_ = core::Fault::count;
}

void EditDoor::take_over(EditDoor& old, const TakeOver& change) noexcept {
  moving_.clear();
  for (const behaviors::ParameterInfo& info : change.to.parameters) {
    for (int slot = info.slot; slot < info.slot + info.size; ++slot) {
      const Ramp& ramp = ramps_[at(slot)];
      const double own = ramp.ticks > 0 ? ramp.to : change.own[at(slot)];
      ramps_[at(slot)] = {};
      if (change.map.slots[at(slot)] >= 0) take_slot(old, info, slot, own, change);
    }
  }
  const std::uint64_t revision = old.revision() + 1;
  for (EditEntrance& entrance : old.entrances_) old.refuse_waiting(entrance, change.tick, revision);
  old.taken_.clear();
  taken_.clear();
  revision_.store(revision, std::memory_order_release);
}

// What the behavior sets itself stays as it is.
void EditDoor::take_slot(const EditDoor& old, const behaviors::ParameterInfo& info, int slot,
                         double own, const TakeOver& change) noexcept {
  const std::size_t was = at(change.map.slots[at(slot)]);
  const Ramp& running = old.ramps_[was];
  const double now = change.before[was];
  const double goal = running.ticks > 0 ? running.to : now;
  const bool outside = info.has_range() && (goal < info.min || goal > info.max);
  const bool same_file = same_bits(change.from.values[was], change.to.values[at(slot)]);
  if ((info.variable || same_file) && !outside) {
    if (running.ticks == 0) return;
    ramps_[at(slot)] = running;
  } else {
    if (same_bits(own, now)) return;
    ramps_[at(slot)] = {now, own, change.tick, change.periods, true};
  }
  moving_.push_back(slot);
}

void EditDoor::rest() noexcept {
  for (const int slot : moving_) ramps_[at(slot)] = {};
  moving_.clear();
}

void EditDoor::refuse_waiting(EditEntrance& entrance, std::int64_t tick,
                              std::uint64_t revision) noexcept {
  entrance.orders_.release(entrance.taken_);
  entrance.taken_ = 0;
  const std::size_t waiting = entrance.orders_.waiting();
  for (std::size_t i = 0; i < waiting; ++i) {
    const EditOrder& order = entrance.orders_.at(i);
    if (order.outcome == EditOutcome::refused) continue;  // has no answer
    EditEntrance::Answer* answer = entrance.answers_.next();
    if (answer == nullptr) break;  // nobody takes them
    answer->answer = {order.id, EditOutcome::stale_revision, tick, revision, 0};
    entrance.answers_.publish();
  }
  entrance.orders_.release(waiting);
}

}  // namespace footfall::engine
