// Lock-step planner traffic; see planner_link.h.
#include "engine/links/planner_link.h"

#include <algorithm>

#include "behaviors/machine/planner_calls.h"

namespace footfall::engine {

using behaviors::PlanAnswer;
using behaviors::PlanRequest;

PlannerLink::PlannerLink(const behaviors::Behavior& behavior, int latency_ticks)
    : behavior_(behavior),
      latency_ticks_(std::max(1, latency_ticks)),
      pending_(std::max<std::size_t>(1, behavior.invokes.size()) *
               (static_cast<std::size_t>(latency_ticks_) + 1)) {}

void PlannerLink::deliver(std::int64_t tick, behaviors::Machine& machine,
                          std::vector<PlanAnswer>* told, bool hand_over) noexcept {
  while (count_ > 0 && pending_[head_].due <= tick) {
    const PlanAnswer& answer = pending_[head_].answer;
    if (!dropped_) {
      if (told != nullptr && told->size() < told->capacity()) told->push_back(answer);
      if (hand_over) machine.deliver(answer);
    }
    head_ = (head_ + 1) % pending_.size();
    --count_;
  }
}

void PlannerLink::post(std::int64_t tick, const behaviors::Machine& machine) noexcept {
  for (const PlanRequest& request : machine.plan_requests()) {
    if (count_ == pending_.size()) continue;  // its deadline will report it
    pending_[(head_ + count_) % pending_.size()] = {
        tick + latency_ticks_, behaviors::answer_of(behavior_, request, machine.parameters())};
    ++count_;
  }
}

void PlannerLink::take_over(const PlannerLink& old) noexcept {
  dropped_ = old.dropped_;
  head_ = count_ = 0;
}

}  // namespace footfall::engine
