// The door's part of a bumpless transfer: continues the edits of the former behavior; see door.h.

#include "behaviors/compiled/take_over_map.h"
#include "core/index.h"
#include "core/same_bits.h"
#include "engine/edits/door.h"

namespace footfall::engine {
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

// Variables, which the behavior sets itself, are kept.
void EditDoor::take_slot(const EditDoor& old, const behaviors::ParameterInfo& info, int slot,
                         double own, const TakeOver& change) noexcept {
  const std::size_t was = at(change.map.slots[at(slot)]);
  const Ramp& running = old.ramps_[was];
  const double now = change.before[was];
  const double goal = running.ticks > 0 ? running.to : now;
  const bool outside = info.has_range() && (goal < info.min || goal > info.max);
  const bool same_file = core::same_bits(change.from.values[was], change.to.values[at(slot)]);
  if ((info.variable || same_file) && !outside) {
    if (running.ticks == 0) return;
    ramps_[at(slot)] = running;
  } else {
    if (core::same_bits(own, now)) return;
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
    if (order.outcome == EditOutcome::refused) continue;  // it has no answer
    EditEntrance::Answer* answer = entrance.answers_.next();
    if (answer == nullptr) break;  // answers are not being taken
    answer->answer = {order.id, EditOutcome::stale_revision, tick, revision, 0};
    entrance.answers_.publish();
  }
  entrance.orders_.release(waiting);
}

}  // namespace footfall::engine
