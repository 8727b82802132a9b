// The queue of edits and their application; see edit_door.h.
#include "engine/edit_door.h"

#include <algorithm>

namespace footfall::engine {
namespace {

EditOrder empty_order(const behaviors::Behavior& behavior) {
  EditOrder order;
  order.values.resize(behavior.values.size());
  return order;
}

void fill(EditOrder& order, const behaviors::Behavior& behavior, const EditBatch& batch) {
  order.source = batch.source;
  order.ramp_ticks = behaviors::periods_of(batch.over, behavior.rate_mhz);
  order.value_count = 0;
  for (const EditValue& edit : batch.values) {
    int slot = behavior.parameters[static_cast<std::size_t>(edit.parameter)].slot;
    slot += std::max(0, edit.component);
    for (const double value : edit.values) order.values[order.value_count++] = {slot++, value};
  }
  order.event_count = batch.events.size();
  std::ranges::copy(batch.events, order.events.begin());
  order.expects_revision = batch.revision.has_value();
  order.expected_revision = batch.revision.value_or(0);
}

}  // namespace

const char* edit_source_name(EditSource source) {
  constexpr const char* kNames[] = {"live", "scenario", "set", "command", "replay"};
  return kNames[static_cast<std::size_t>(source)];
}

EditDoor::EditDoor(const behaviors::Behavior& behavior, std::size_t capacity)
    : behavior_(behavior),
      orders_(capacity, empty_order(behavior)),
      answers_(capacity),
      ramps_(behavior.values.size()) {
  moving_.reserve(behavior.values.size());
}

EditReply EditDoor::submit(const EditBatch& batch) {
  EditReply reply{batch.id != 0 ? batch.id : next_id_, {}};
  reply.reasons = reasons_against(behavior_, batch, revision());
  EditOrder* order = outstanding_ < answers_.capacity() ? orders_.next() : nullptr;
  if (order == nullptr) {
    reply.reasons.push_back("the queue of edits is full: " + std::to_string(orders_.capacity()) +
                            " of them wait");
  }
  if (!reply.accepted()) return reply;
  next_id_ = std::max(next_id_, reply.id) + 1;
  order->id = reply.id;
  fill(*order, behavior_, batch);
  ++outstanding_;
  orders_.publish();
  return reply;
}

bool EditDoor::resubmit(const EditOrder& logged) {
  const auto slots = static_cast<int>(behavior_.values.size());
  const auto events = static_cast<int>(behavior_.events.size());
  const bool fits =
      logged.ramp_ticks >= 0 && logged.value_count <= behavior_.values.size() &&
      std::ranges::all_of(logged.new_values(),
                          [&](const SlotValue& v) { return v.slot >= 0 && v.slot < slots; }) &&
      std::ranges::all_of(logged.new_events(), [&](int e) { return e >= 0 && e < events; });
  EditOrder* order = outstanding_ < answers_.capacity() ? orders_.next() : nullptr;
  if (!fits || order == nullptr) return false;
  order->id = logged.id;
  order->source = logged.source;
  order->ramp_ticks = logged.ramp_ticks;
  std::ranges::copy(logged.new_values(), order->values.begin());
  order->value_count = logged.value_count;
  order->events = logged.events;
  order->event_count = logged.event_count;
  order->expects_revision = false;
  ++outstanding_;
  orders_.publish();
  return true;
}

bool EditDoor::take_answer(EditAnswer& answer) noexcept {
  if (answers_.waiting() == 0) return false;
  answer = answers_.at(0);
  answers_.release(1);
  --outstanding_;
  return true;
}

void EditDoor::apply(std::int64_t tick, behaviors::Machine& machine) noexcept {
  orders_.release(taken_);
  taken_ = 0;
  advance_ramps(tick, machine.parameters());
  for (const std::size_t waiting = orders_.waiting(); taken_ < waiting; ++taken_) {
    EditOrder& order = orders_.at(taken_);
    EditAnswer* answer = answers_.next();
    if (answer == nullptr || order.event_count > machine.outside_room()) return;
    std::uint64_t revision = revision_.load(std::memory_order_relaxed);
    if (order.expects_revision && order.expected_revision != revision) {
      order.outcome = EditOutcome::stale_revision;
    } else {
      order.outcome = EditOutcome::applied;
      write(order, tick, machine.parameters());
      for (const int event : order.new_events()) machine.raise(event);
      revision_.store(++revision, std::memory_order_release);
    }
    order.revision = revision;
    *answer = {order.id, order.outcome, tick, revision};
    answers_.publish();
  }
}

// A later edit of a slot takes it over from where the earlier one has brought it.
void EditDoor::write(const EditOrder& order, std::int64_t tick, std::span<double> values) noexcept {
  for (const SlotValue& edit : order.new_values()) {
    const auto slot = static_cast<std::size_t>(edit.slot);
    const bool was_moving = ramps_[slot].ticks > 0;
    ramps_[slot] = {values[slot], edit.value, tick, order.ramp_ticks};
    if (order.ramp_ticks == 0) {
      values[slot] = edit.value;
      if (was_moving) std::erase(moving_, edit.slot);
    } else if (!was_moving) {
      moving_.push_back(edit.slot);
    }
  }
}

// v(k) = from + (to - from) k/N, exactly `to` at k = N.
void EditDoor::advance_ramps(std::int64_t tick, std::span<double> values) noexcept {
  const auto arrived = [&](int s) {
    const auto slot = static_cast<std::size_t>(s);
    Ramp& ramp = ramps_[slot];
    const std::int64_t k = tick - ramp.start;
    if (k < ramp.ticks) {
      const double part = static_cast<double>(k) / static_cast<double>(ramp.ticks);
      values[slot] = ramp.from + (ramp.to - ramp.from) * part;
      return false;
    }
    values[slot] = ramp.to;
    ramp.ticks = 0;
    return true;
  };
  std::erase_if(moving_, arrived);
}

}  // namespace footfall::engine
