// Linear ramps of parameters' values, one a slot: how edits that take time are applied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace footfall::engine {

struct Ramp {
  double from = 0.0, to = 0.0;
  std::int64_t start = 0, ticks = 0;  // ticks 0: at rest
  bool smooth = false;                // torque steps are limited during the ramp
};

class ParameterRamps {
 public:
  explicit ParameterRamps(std::size_t slots);

  // The rest is for the tick: allocates nothing.

  // Writes the value of each moving slot at `tick`: v(k) = from + (to - from) k/N, exactly `to` at
  // k = N. Returns whether one of them is smooth.
  bool advance(std::int64_t tick, std::span<double> values) noexcept;
  // Replaces the ramp of a slot; one of 0 ticks puts it at rest.
  void set(int slot, const Ramp& ramp) noexcept;
  // Stops all; their values stay as they are.
  void clear() noexcept;
  const Ramp& of(int slot) const noexcept { return ramps_[static_cast<std::size_t>(slot)]; }
  // The end of a slot's ramp, or `value` if it is at rest.
  double target(int slot, double value) const noexcept {
    return of(slot).ticks > 0 ? of(slot).to : value;
  }
  // Target of each of `values`.
  void copy_targets(std::span<const double> values, std::span<double> targets) const noexcept;

 private:
  std::vector<Ramp> ramps_;  // by slot
  std::vector<int> moving_;  // slots with active ramps
};

}  // namespace footfall::engine
