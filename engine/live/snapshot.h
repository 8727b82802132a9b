// Telemetry data passed from the tick to the link: copies in preallocated memory, through a queue
// without waiting on either side.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "core/capacities.h"
#include "core/fault.h"
#include "core/realtime/ring.h"

namespace footfall_lcm {
class telemetry_t;
}

namespace footfall::behaviors {
struct Behavior;
}

namespace footfall::engine {

class ControlLoop;
enum class LoopState : std::uint8_t;

struct LiveSnapshot {
  bool telemetry = false;  // telemetry is due; otherwise only values
  std::int64_t tick = 0;
  double time = 0.0;  // s
  LoopState state{};
  std::uint64_t revision = 0;  // revision of the door
  std::int64_t tick_ns = 0, worst_ns = 0;
  std::vector<double> now, target;  // parameters by slot: current values and ramp targets
  std::vector<double> signals;
  std::vector<int> active;  // atomic states; only the first active_count are valid
  std::size_t active_count = 0;
  std::vector<int> tasks;  // active ones, into Behavior::task_names, ascending priority; likewise
  std::size_t task_count = 0;
  core::FaultCounters faults;
};

// The queue of one loop.
class LiveFeed {
 public:
  // rate: telemetry messages per second of the run; 0: none.
  LiveFeed(const ControlLoop& loop, double rate);

  // Called by the tick's thread after compute(): copies data that are due (values at least 50 times
  // a second, and always at the run's last tick). tick_ns: duration of this tick. No lock, no
  // allocation; if the queue is full the copy is dropped and counted.
  void post(const ControlLoop& loop, std::int64_t tick_ns) noexcept;
  std::int64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  // Called by the link's thread: the oldest waiting snapshot (nullptr if none), and its release.
  const LiveSnapshot* front() noexcept;
  void pop() noexcept { ring_.release(1); }

 private:
  core::Ring<LiveSnapshot> ring_;
  std::int64_t telemetry_every_, values_every_;  // ticks; 0: never
  std::int64_t worst_ns_ = 0;
  std::atomic<std::int64_t> dropped_{0};
};

// Fills everything except session, generation, revision and dropped.
void fill_telemetry(const LiveSnapshot& snapshot, const behaviors::Behavior& behavior,
                    footfall_lcm::telemetry_t& message);

}  // namespace footfall::engine
