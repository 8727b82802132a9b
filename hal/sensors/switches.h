// Foot switches: a normal force above a threshold closes one, and both its closing and its opening
// are reported late. Forces are those of ticks, and reports too: a change is seen at most a tick
// late, and reported in the first tick at or after its time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/sensors/errors.h"
#include "hal/sensors/noise.h"

namespace footfall::hal {

class Switches {
 public:
  Switches(const SwitchErrors& errors, const SensorPlaces& places, double period,
           std::uint64_t seed);

  // Reports begin with the forces of the first sample.
  void start() noexcept;
  // One call a tick; `normal`: N, by contact.
  void sample(std::span<const double> normal, std::span<bool> closed) noexcept;

 private:
  struct Switch {
    NoiseStream jitter, bounce;
    std::vector<std::int64_t> due;  // ticks of changes on their way: a ring
    std::size_t oldest = 0, waiting = 0;
    std::int64_t last_due = 0;
    std::int64_t bounces_until = -1;
    bool real = false, reported = false;
  };
  void follow(Switch& s, bool real) noexcept;

  SwitchErrors errors_;
  double period_;
  std::array<bool, core::kMaxContacts> has_switch_;
  std::vector<Switch> switches_;
  std::int64_t tick_ = 0;
};

}  // namespace footfall::hal
