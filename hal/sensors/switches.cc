// Changes of foot switches on their way; see switches.h.
#include "hal/sensors/switches.h"

#include <algorithm>
#include <cmath>

namespace footfall::hal {
namespace {

constexpr double kTickRounding = 1e-9;  // ticks

std::int64_t ticks_of(double time, double period) noexcept {
  return static_cast<std::int64_t>(std::ceil(time / period - kTickRounding));
}

}  // namespace

Switches::Switches(const SwitchErrors& errors, const SensorPlaces& places, double period,
                   std::uint64_t seed)
    : errors_(errors), period_(period), has_switch_(places.has_switch) {
  const auto longest = static_cast<std::size_t>(ticks_of(errors.delay + errors.jitter, period)) + 2;
  for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(places.contacts); ++c) {
    switches_.push_back({.jitter = NoiseStream(seed, NoiseSource::switch_jitter, c),
                         .bounce = NoiseStream(seed, NoiseSource::switch_bounce, c),
                         .due = std::vector<std::int64_t>(longest)});
  }
}

void Switches::start() noexcept {
  for (Switch& s : switches_) {
    s.oldest = s.waiting = 0;
    s.last_due = 0;
    s.bounces_until = -1;
  }
  tick_ = 0;
}

void Switches::follow(Switch& s, bool real) noexcept {
  if (tick_ == 0) s.real = s.reported = real;
  if (real != s.real) {
    s.real = real;
    const double delay = errors_.delay + errors_.jitter * s.jitter.uniform();
    // Changes keep their order.
    s.last_due = std::max(s.last_due, tick_ + ticks_of(delay, period_));
    s.due[(s.oldest + s.waiting) % s.due.size()] = s.last_due;
    ++s.waiting;
  }
  while (s.waiting > 0 && s.due[s.oldest] <= tick_) {
    s.oldest = (s.oldest + 1) % s.due.size();
    --s.waiting;
    s.reported = !s.reported;
    s.bounces_until = s.reported ? tick_ + ticks_of(errors_.bounce, period_) : -1;
  }
}

void Switches::sample(std::span<const double> normal, std::span<bool> closed) noexcept {
  for (std::size_t c = 0; c < switches_.size(); ++c) {
    if (!has_switch_[c]) {
      closed[c] = normal[c] > 0.0;
      continue;
    }
    Switch& s = switches_[c];
    follow(s, normal[c] > errors_.threshold);
    closed[c] = s.reported;
    if (tick_ < s.bounces_until) closed[c] = s.bounce.uniform() < 0.5;
  }
  ++tick_;
}

}  // namespace footfall::hal
