// Absolute-time pacing of a paced run: sleeps to the next period boundary on CLOCK_MONOTONIC. After
// an overrun it skips to the next boundary instead of running late ticks in a burst.
#pragma once

#include <cstdint>

namespace footfall::engine {

class Pacer {
 public:
  explicit Pacer(double period_s);
  // Sleeps until the next boundary. False: that boundary had passed already (an overrun); the next
  // one is then the first in the future.
  bool wait() noexcept;

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_ = 0;
};

}  // namespace footfall::engine
