// A control loop in another's place, between two ticks; see ControlLoop::take_over.
#include "behaviors/compiled/take_over_map.h"
#include "core/index.h"
#include "engine/tick/control_loop.h"

namespace footfall::engine {

bool ControlLoop::may_take_over(const ControlLoop& old,
                                const behaviors::TakeOverMap& map) const noexcept {
  if (old.state() != LoopState::running) return false;
  if (old.machine_->control().has_other) return false;
  for (const int s : old.machine_->active_atomic()) {
    if (!behaviors::permits_reload(old.behavior_, s)) return false;
  }
  return machine_->has_configuration_of(*old.machine_, map);
}

void ControlLoop::take_over(ControlLoop& old, const behaviors::TakeOverMap& map,
                            ValueChange change) noexcept {
  tick_ = old.tick_;
  sensors_ = old.sensors_;
  commands_ = old.commands_;
  estimate_ = old.estimate_;
  sensing_.take_over(old.sensing_, old.estimate_);
  fresh_ = old.fresh_;
  // Back at once: what brought the former behavior back is to be reacted to, if it stays.
  faults_.take_over(old.faults_, change == ValueChange::at_once);
  swings_.take_over(old.swings_);
  slips_.take_over(old.slips_);
  safety_.take_over(old.safety_);
  writer_.take_over(old.writer_, map);
  const bool ramped = change == ValueChange::ramped;
  const std::int64_t periods =
      ramped ? behaviors::periods_of(behavior_.robot.edit_ramp, behavior_.rate_mhz) : 0;
  edits_.take_over(old.edits_, {old.behavior_, behavior_, map, old.machine_->parameters(),
                                machine_->parameters(), tick_, periods});
  if (outside_.playing()) edits_.rest();
  machine_->take_over(*old.machine_, map);
  controller_.take_over(old.controller_, map.instances);
  outside_.take_over(old.outside_, *machine_);
  link_.forget();
}

}  // namespace footfall::engine
