// What talks to people while a robot runs: takes their edits to the door, tells them values and
// telemetry. The executive starts it, hands it each tick and stops it; which network it uses only
// the implementation knows (engine/lcm/link.h).
#pragma once

#include <cstdint>
#include <memory>

namespace footfall::engine {

class ControlLoop;

// What a port needs of one loop: queues of the behavior's size, an entrance of the loop's door.
class LiveBinding {
 public:
  virtual ~LiveBinding() = default;
};

class LivePort {
 public:
  virtual ~LivePort() = default;

  // After ControlLoop::start(): begins to answer. May throw.
  virtual void start() = 0;
  // The tick's thread, after each compute(); tick_ns: its duration. No lock, no allocation.
  virtual void post(const ControlLoop& loop, std::int64_t tick_ns) noexcept = 0;
  // After the last tick: tells it, refuses edits that wait. Any number of times.
  virtual void stop() noexcept = 0;

  // Reload. Room for what another loop will post; any thread, while that loop runs, too.
  virtual std::unique_ptr<LiveBinding> prepare(ControlLoop& loop) const = 0;
  // Called by the tick's thread between two ticks: post() now belongs to the loop for which
  // `binding` was prepared. The previous loop must exist, unused, until rebound(); only then the
  // next rebind is allowed. No lock, no allocation.
  virtual void rebind(std::unique_ptr<LiveBinding> binding) noexcept = 0;
  virtual bool rebound() const noexcept = 0;
};

}  // namespace footfall::engine
