// Interface for live tuning during a run: passes edits to the door, and publishes values and
// telemetry. The executive starts it, passes it every tick and stops it; only the implementation
// depends on a network (engine/lcm/link.h).
#pragma once

#include <cstdint>
#include <memory>

namespace footfall::engine {

class ControlLoop;

// Data of a port for one loop: queues of the behavior's size, an entrance of the loop's door.
class LiveBinding {
 public:
  virtual ~LiveBinding() = default;
};

class LivePort {
 public:
  virtual ~LivePort() = default;

  // Starts answering; call after ControlLoop::start(). May throw.
  virtual void start() = 0;
  // Called by the tick's thread after each compute(); tick_ns: its duration. No lock, no
  // allocation.
  virtual void post(const ControlLoop& loop, std::int64_t tick_ns) noexcept = 0;
  // Call after the last tick: publishes it, refuses waiting edits. Can be repeated.
  virtual void stop() noexcept = 0;

  // Reload: allocates data for another loop; any thread, also while that loop runs.
  virtual std::unique_ptr<LiveBinding> prepare(ControlLoop& loop) const = 0;
  // Called by the tick's thread between two ticks: post() now belongs to the loop for which
  // `binding` was prepared. The previous loop must exist, unused, until rebound(); only then the
  // next rebind is allowed. No lock, no allocation.
  virtual void rebind(std::unique_ptr<LiveBinding> binding) noexcept = 0;
  virtual bool rebound() const noexcept = 0;
};

}  // namespace footfall::engine
