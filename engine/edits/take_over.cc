// The door's part of a bumpless transfer: continues the edits of the former behavior; see door.h.
#include "behaviors/compiled/take_over_map.h"
#include "core/index.h"
#include "core/same_bits.h"
#include "engine/edits/door.h"

namespace footfall::engine {

void EditDoor::take_over(EditDoor& old, const TakeOver& change) noexcept {
  for (const behaviors::ParameterInfo& info : change.to.parameters) {
    for (int slot = info.slot; slot < info.slot + info.size; ++slot) {
      const double own = ramps_.target(slot, change.own[at(slot)]);
      ramps_.set(slot, {});
      if (change.map.slots[at(slot)] >= 0) take_slot(old, info, slot, own, change);
    }
  }
  const std::uint64_t revision = old.revision() + 1;
  for (EditEntrance& entrance : old.entrances_) old.refuse_waiting(entrance, change.tick, revision);
  old.taken_.clear();
  taken_.clear();
  revision_.store(revision, std::memory_order_release);
}

// Variables, which the behavior sets itself, are kept.
void EditDoor::take_slot(const EditDoor& old, const behaviors::ParameterInfo& info, int slot,
                         double own, const TakeOver& change) noexcept {
  const int former = change.map.slots[at(slot)];
  const std::size_t was = at(former);
  const Ramp& running = old.ramps_.of(former);
  const double now = change.before[was];
  const double goal = old.ramps_.target(former, now);
  const bool outside = info.has_range() && (goal < info.min || goal > info.max);
  const bool same_file = core::same_bits(change.from.values[was], change.to.values[at(slot)]);
  if ((info.variable || same_file) && !outside) {
    if (running.ticks == 0) return;
    ramps_.set(slot, running);
  } else {
    if (core::same_bits(own, now)) return;
    // One without duration ends in this tick.
    const bool at_once = change.periods == 0;
    ramps_.set(slot, {now, own, at_once ? change.tick - 1 : change.tick,
                      at_once ? 1 : change.periods, true});
  }
}

void EditDoor::refuse_waiting(EditEntrance& entrance, std::int64_t tick,
                              std::uint64_t revision) noexcept {
  entrance.orders_.release(entrance.taken_);
  entrance.taken_ = 0;
  const std::size_t waiting = entrance.orders_.waiting();
  for (std::size_t i = 0; i < waiting; ++i) {
    const EditOrder& order = entrance.orders_.at(i);
    if (order.outcome == EditOutcome::refused) continue;  // it has no answer
    EditEntrance::Answer* answer = entrance.answers_.next();
    if (answer == nullptr) break;  // answers are not being taken
    answer->answer = {order.id, EditOutcome::stale_revision, tick, revision, 0};
    entrance.answers_.publish();
  }
  entrance.orders_.release(waiting);
}

}  // namespace footfall::engine
