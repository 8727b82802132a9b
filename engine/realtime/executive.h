// The executive: the one loop around ControlLoop. It paces, senses, computes and actuates until
// something ends the run, and then brings the robot to a safe stop, whatever ended it. What is
// recorded, judged or shown, and what acts on the world, is attached from outside.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/process/machine_error.h"
#include "core/realtime/timing_histogram.h"
#include "engine/realtime/live_port.h"
#include "engine/tick/control_loop.h"

namespace footfall::engine {

// Called by the executive on the tick's thread, never within sense(), compute() or actuate(). May
// allocate and throw; an exception ends the run (see RunInterrupted).
class TickObserver {
 public:
  virtual ~TickObserver() = default;
  // After ControlLoop::start().
  virtual void started(ControlLoop& /*loop*/) {}
  // Before each tick. True: the run ends here.
  virtual bool ends(const ControlLoop& /*loop*/) { return false; }
  // Before sense(): what acts on the robot or its values from outside.
  virtual void before_tick(ControlLoop& /*loop*/) {}
  // Between compute() and actuate(): signals, machine and commands are those of this tick.
  virtual void after_compute(ControlLoop& /*loop*/) {}
  // In the place of after_compute(), for a tick that the loop before will do again: its commands
  // never reach the hardware.
  virtual void withdrawn(ControlLoop& /*loop*/) {}
  // `now` goes on in the place of the loop before. Must not allocate.
  virtual void exchanged(ControlLoop& /*now*/) {}
};

// Where a loop comes from that takes over from the one that runs: reloads. Everything it hands out
// was prepared beside the tick.
class LoopExchange {
 public:
  virtual ~LoopExchange() = default;
  // Between two ticks: the loop that has taken over, nullptr if none has. No lock that waits, no
  // allocation.
  virtual ControlLoop* swap() = 0;
  // Between compute() and actuate() of a tick in which a loop on probation has failed: the loop
  // that does this tick again. No lock, no allocation.
  virtual ControlLoop* take_back() = 0;
  // What the live port needs of the loop returned last; nullptr without port.
  virtual std::unique_ptr<LiveBinding> take_binding() = 0;
};

// Thrown by run() for an exception that came after the first tick; the robot was stopped before.
class RunInterrupted : public core::MachineError {
 public:
  RunInterrupted(double time, const std::string& why);
};

enum class ExecutiveEnd : std::uint8_t {
  loop,      // ControlLoop::state() says how
  asked,     // the stop flag
  observer,  // TickObserver::ends()
};

struct ExecutiveSettings {
  bool paced = false;                       // by the wall clock; else as fast as it goes
  const std::atomic<bool>* stop = nullptr;  // stop_on_signals(), or any other flag
  LivePort* live = nullptr;                 // not started yet
  LoopExchange* exchange = nullptr;         // nullptr: one loop from start to end
  // Counts heap calls of this thread while armed, within compute(); nullptr: not counted.
  void (*arm_allocations)(bool) = nullptr;
};

class Executive {
 public:
  // All that it is given must outlive it.
  Executive(ControlLoop& loop, const ExecutiveSettings& settings);
  Executive(const Executive&) = delete;
  Executive& operator=(const Executive&) = delete;

  // Before run(); observers are called in the order in which they were attached.
  void attach(TickObserver& observer) { observers_.push_back(&observer); }
  // Once. Throws what ControlLoop::start(), TickObserver::started() or LivePort::start() throws,
  // and RunInterrupted. However it returns, the hardware's safe_stop() was called.
  ExecutiveEnd run();

  // The loop that runs, or ran last.
  ControlLoop& loop() const noexcept { return *loop_; }
  const core::TimingHistogram& tick_time() const noexcept { return tick_time_; }
  int exchanges() const noexcept { return exchanges_; }  // loops taken back count again

 private:
  void start();
  void work();
  bool ended();
  void tick();
  void compute() noexcept;
  void swap();
  void go_on(ControlLoop& next);
  void bind_live() noexcept;
  void stop() noexcept;

  ControlLoop* loop_;
  ExecutiveSettings settings_;
  std::vector<TickObserver*> observers_;
  std::unique_ptr<LiveBinding> binding_;  // that the live port takes as soon as it can
  core::TimingHistogram tick_time_;
  ExecutiveEnd end_ = ExecutiveEnd::loop;
  int exchanges_ = 0;
};

}  // namespace footfall::engine
