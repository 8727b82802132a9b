// Records what comes from outside; see input_trace.h.
#include "engine/tick/input_trace.h"

#include <algorithm>
#include <cstring>

namespace footfall::engine {
namespace {
constexpr std::size_t kEvents = 256;  // more than the machine's queue holds
constexpr std::size_t kPlans = 64;    // answers that one tick may get, at least
}  // namespace

void InputTrace::size_for(const behaviors::Behavior& behavior) {
  writes.reserve(behavior.values.size());
  events.reserve(kEvents);
  const std::size_t most = std::max(kPlans, behavior.invokes.size());
  plans.reserve(most);
  planned.reserve(most);
}

void InputTrace::clear() noexcept {
  writes.clear();
  events.clear();
  plans.clear();
  planned.clear();
  limit_steps = late = requests_lost = scripts_stuck = false;
}

void WriteWatch::find(std::span<const double> parameters,
                      std::vector<behaviors::SlotValue>& writes) noexcept {
  if (std::memcmp(known_.data(), parameters.data(), parameters.size_bytes()) == 0) return;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (std::memcmp(&known_[i], &parameters[i], sizeof(double)) == 0) continue;
    if (writes.size() < writes.capacity()) writes.push_back({static_cast<int>(i), parameters[i]});
  }
}

void WriteWatch::remember(std::span<const double> parameters) noexcept {
  std::copy(parameters.begin(), parameters.end(), known_.begin());
}

}  // namespace footfall::engine
