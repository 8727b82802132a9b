#include "engine/edits/ramps.h"

#include <algorithm>

#include "core/index.h"

namespace footfall::engine {

ParameterRamps::ParameterRamps(std::size_t slots) : ramps_(slots) { moving_.reserve(slots); }

bool ParameterRamps::advance(std::int64_t tick, std::span<double> values) noexcept {
  bool smooth = false;
  std::erase_if(moving_, [&](int slot) {
    Ramp& ramp = ramps_[at(slot)];
    smooth |= ramp.smooth;
    const std::int64_t k = tick - ramp.start;
    if (k < ramp.ticks) {
      const double part = static_cast<double>(k) / static_cast<double>(ramp.ticks);
      values[at(slot)] = ramp.from + (ramp.to - ramp.from) * part;
      return false;
    }
    values[at(slot)] = ramp.to;
    ramp.ticks = 0;
    return true;
  });
  return smooth;
}

void ParameterRamps::set(int slot, const Ramp& ramp) noexcept {
  const bool was_moving = of(slot).ticks > 0;
  ramps_[at(slot)] = ramp;
  if (ramp.ticks == 0) {
    if (was_moving) std::erase(moving_, slot);
  } else if (!was_moving) {
    moving_.push_back(slot);
  }
}

void ParameterRamps::clear() noexcept {
  for (const int slot : moving_) ramps_[at(slot)] = {};
  moving_.clear();
}

void ParameterRamps::copy_targets(std::span<const double> values,
                                  std::span<double> targets) const noexcept {
  std::ranges::copy(values, targets.begin());
  for (const int slot : moving_) targets[at(slot)] = of(slot).to;
}

}  // namespace footfall::engine
