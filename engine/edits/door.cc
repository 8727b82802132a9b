// Queues and application of edits; see door.h.
#include "engine/edits/door.h"

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
  order.ramp_ticks = behaviors::periods_of(ramp_time(behavior, batch), behavior.rate_mhz);
  order.value_count = batch.values.size();
  std::ranges::copy(batch.values, order.values.begin());
  order.event_count = batch.events.size();
  std::ranges::copy(batch.events, order.events.begin());
  order.expects_revision = batch.revision.has_value();
  order.expected_revision = batch.revision.value_or(0);
  order.who.set(batch.who);
  order.note.set(batch.note);
  order.outcome = EditOutcome::applied;
}

bool is_smooth(EditSource source) {
  return source == EditSource::live || source == EditSource::scenario;
}

}  // namespace

double ramp_time(const behaviors::Behavior& behavior, const EditBatch& batch) {
  const bool spread = batch.source == EditSource::live && behavior.has_robot;
  return spread ? std::max(batch.over, behavior.robot.edit_ramp) : batch.over;
}

const char* edit_source_name(EditSource source) {
  constexpr const char* kNames[] = {"live", "scenario", "set", "command", "replay"};
  return kNames[static_cast<std::size_t>(source)];
}

EditEntrance::EditEntrance(const behaviors::Behavior& behavior, std::size_t capacity,
                           const std::atomic<std::uint64_t>& revision)
    : behavior_(behavior),
      orders_(capacity, empty_order(behavior)),
      answers_(capacity, {{}, std::vector<double>(behavior.values.size())}),
      revision_(revision) {}

EditOrder* EditEntrance::free_order() noexcept {
  return outstanding_ < answers_.capacity() ? orders_.next() : nullptr;
}

void EditEntrance::publish() noexcept {
  ++outstanding_;
  orders_.publish();
}

EditReply EditEntrance::submit(const EditBatch& batch) {
  EditReply reply{batch.id != 0 ? batch.id : next_id_, {}};
  reply.reasons = reasons_against(behavior_, batch, revision());
  EditOrder* order = free_order();
  if (order == nullptr) {
    reply.reasons.push_back("the queue of edits is full: " + std::to_string(orders_.capacity()) +
                            " of them wait");
  }
  if (!reply.accepted()) return reply;
  next_id_ = std::max(next_id_, reply.id) + 1;
  order->id = reply.id;
  fill(*order, behavior_, batch);
  publish();
  return reply;
}

bool EditEntrance::resubmit(const EditOrder& logged) {
  const auto slots = static_cast<int>(behavior_.values.size());
  const auto events = static_cast<int>(behavior_.events.size());
  const bool fits =
      logged.ramp_ticks >= 0 && logged.value_count <= behavior_.values.size() &&
      std::ranges::all_of(
          logged.new_values(),
          [&](const behaviors::SlotValue& v) { return v.slot >= 0 && v.slot < slots; }) &&
      std::ranges::all_of(logged.new_events(), [&](int e) { return e >= 0 && e < events; });
  EditOrder* order = free_order();
  if (!fits || order == nullptr) return false;
  *order = logged;
  order->values.resize(behavior_.values.size());
  order->expects_revision = false;
  order->outcome = EditOutcome::applied;
  publish();
  return true;
}

bool EditEntrance::tell_refused(EditSource source, std::string_view who,
                                std::string_view note) noexcept {
  EditOrder* order = orders_.next();
  if (order == nullptr) return false;
  order->id = 0;
  order->source = source;
  order->ramp_ticks = 0;
  order->value_count = order->event_count = 0;
  order->who.set(who);
  order->note.set(note);
  order->outcome = EditOutcome::refused;
  orders_.publish();
  return true;
}

bool EditEntrance::take_answer(EditAnswer& answer, std::span<double> former) noexcept {
  if (answers_.waiting() == 0) return false;
  const Answer& oldest = answers_.at(0);
  answer = oldest.answer;
  std::copy_n(oldest.former.begin(), std::min(former.size(), answer.value_count), former.begin());
  answers_.release(1);
  --outstanding_;
  return true;
}

EditDoor::EditDoor(const behaviors::Behavior& behavior, std::size_t capacity, std::size_t entrances)
    : ramps_(behavior.values.size()) {
  for (std::size_t i = 0; i < entrances; ++i) {
    entrances_.emplace_back(behavior, capacity, revision_);
  }
  taken_.reserve(capacity * entrances);
}

void EditDoor::apply(std::int64_t tick, behaviors::Machine& machine) noexcept {
  taken_.clear();
  moved_ = ramps_.advance(tick, machine.parameters());
  for (EditEntrance& entrance : entrances_) {
    entrance.orders_.release(entrance.taken_);
    entrance.taken_ = 0;
    take(entrance, tick, machine);
  }
}

void EditDoor::take(EditEntrance& entrance, std::int64_t tick,
                    behaviors::Machine& machine) noexcept {
  for (const std::size_t waiting = entrance.orders_.waiting(); entrance.taken_ < waiting;
       ++entrance.taken_) {
    EditOrder& order = entrance.orders_.at(entrance.taken_);
    std::uint64_t revision = revision_.load(std::memory_order_relaxed);
    if (order.outcome != EditOutcome::refused) {
      EditEntrance::Answer* answer = entrance.answers_.next();
      if (answer == nullptr || order.event_count > machine.outside_room()) return;
      if (order.expects_revision && order.expected_revision != revision) {
        order.outcome = EditOutcome::stale_revision;
      } else {
        write(order, tick, machine.parameters(), answer->former);
        for (const int event : order.new_events()) machine.raise(event);
        revision_.store(++revision, std::memory_order_release);
      }
      answer->answer = {order.id, order.outcome, tick, revision, order.value_count};
      entrance.answers_.publish();
    }
    order.revision = revision;
    taken_.push_back(&order);
  }
}

// A later edit of a slot continues from the value reached by the earlier one.
void EditDoor::write(const EditOrder& order, std::int64_t tick, std::span<double> values,
                     std::span<double> former) noexcept {
  const bool smooth = is_smooth(order.source);
  moved_ |= smooth && order.value_count > 0;
  for (std::size_t i = 0; i < order.value_count; ++i) {
    const behaviors::SlotValue& edit = order.values[i];
    double& value = values[static_cast<std::size_t>(edit.slot)];
    former[i] = ramps_.target(edit.slot, value);
    if (order.ramp_ticks == 0) value = edit.value;
    ramps_.set(edit.slot, {value, edit.value, tick, order.ramp_ticks, smooth});
  }
}

}  // namespace footfall::engine
