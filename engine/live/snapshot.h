// What the tick hands to the link for telemetry: a copy of the moment in memory that is there
// already, through a queue that neither side waits for.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "core/fault.h"
#include "core/limits.h"
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
  bool telemetry = false;  // due; else it is for the values alone
  std::int64_t tick = 0;
  double time = 0.0;  // s
  LoopState state{};
  std::uint64_t revision = 0;  // of the door
  std::int64_t tick_ns = 0, worst_ns = 0;
  std::vector<double> now, target;  // parameters, by slot; where those go that ramp
  std::vector<double> signals;
  std::vector<int> active;  // atomic states; the first active_count count
  std::size_t active_count = 0;
  std::vector<int> tasks;  // in force: into Behavior::task_names, ascending priority; likewise
  std::size_t task_count = 0;
  core::FaultCounters faults;
};

// The queue of one loop.
class LiveFeed {
 public:
  // rate: of telemetry, per second of the run; 0: none.
  LiveFeed(const ControlLoop& loop, double rate);

  // The tick's thread, after compute(): copies what is due (the values 50 times a second at least,
  // and whatever the run's last tick is). tick_ns: what this tick took. No lock, no allocation; a
  // full queue drops, and counts that.
  void post(const ControlLoop& loop, std::int64_t tick_ns) noexcept;
  std::int64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  // The link's thread: the oldest that waits (nullptr: none), and giving it back.
  const LiveSnapshot* front() noexcept;
  void pop() noexcept { ring_.release(1); }

 private:
  core::Ring<LiveSnapshot> ring_;
  std::int64_t telemetry_every_, values_every_;  // ticks; 0: never
  std::int64_t worst_ns_ = 0;
  std::atomic<std::int64_t> dropped_{0};
};

// All but session, generation, revision and dropped.
void fill_telemetry(const LiveSnapshot& snapshot, const behaviors::Behavior& behavior,
                    footfall_lcm::telemetry_t& message);

}  // namespace footfall::engine
