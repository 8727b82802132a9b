// A control loop in another's place, between two ticks; see ControlLoop::take_over.
#include <algorithm>

#include "behaviors/compiled/take_over_map.h"
#include "core/index.h"
#include "engine/tick/control_loop.h"

namespace footfall::engine {

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
  overruns_ = change == ValueChange::at_once ? 0 : old.overruns_;
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

}  // namespace footfall::engine
