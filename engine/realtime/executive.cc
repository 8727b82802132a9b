// Pace, sense, compute, actuate, stop; see executive.h.
#include "engine/realtime/executive.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "engine/realtime/pacer.h"

namespace footfall::engine {

using Clock = std::chrono::steady_clock;

RunInterrupted::RunInterrupted(double time, const std::string& why)
    : core::MachineError(
          fmt::format("the robot was stopped at {:.3f} s, by an exception: {}", time, why)) {}

Executive::Executive(ControlLoop& loop, const ExecutiveSettings& settings)
    : loop_(&loop), settings_(settings) {}

ExecutiveEnd Executive::run() {
  try {
    start();
  } catch (...) {
    stop();
    throw;
  }
  try {
    work();
  } catch (const std::exception& error) {
    stop();
    throw RunInterrupted(loop_->time(), error.what());
  } catch (...) {
    stop();
    throw RunInterrupted(loop_->time(), "it is of an unknown type");
  }
  stop();
  return end_;
}

void Executive::start() {
  loop_->start();
  for (TickObserver* const observer : observers_) observer->started(*loop_);
  if (settings_.live != nullptr) settings_.live->start();
}

void Executive::work() {
  Pacer pacer(loop_->period());
  while (!ended()) {
    if (settings_.paced) loop_->late(!pacer.wait());
    tick();
  }
}

bool Executive::ended() {
  if (settings_.stop != nullptr && settings_.stop->load()) {
    end_ = ExecutiveEnd::asked;
    return true;
  }
  if (loop_->state() != LoopState::running) return true;
  for (TickObserver* const observer : observers_) {
    if (!observer->ends(*loop_)) continue;
    end_ = ExecutiveEnd::observer;
    return true;
  }
  return false;
}

void Executive::tick() {
  if (settings_.exchange != nullptr) swap();
  for (TickObserver* const observer : observers_) observer->before_tick(*loop_);
  loop_->sense();
  compute();
  if (settings_.exchange != nullptr && loop_->failed_by() != core::Fault::count) {
    for (TickObserver* const observer : observers_) observer->withdrawn(*loop_);
    if (ControlLoop* const before = settings_.exchange->take_back()) {
      go_on(*before);
      compute();  // a loop never computes the same tick twice
    }
  }
  for (TickObserver* const observer : observers_) observer->after_compute(*loop_);
  loop_->actuate();
}

void Executive::compute() noexcept {
  const Clock::time_point before = Clock::now();
  const auto elapsed = [before] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - before).count();
  };
  if (settings_.arm_allocations != nullptr) settings_.arm_allocations(true);
  loop_->compute();
  if (settings_.live != nullptr && binding_ == nullptr) settings_.live->post(*loop_, elapsed());
  if (settings_.arm_allocations != nullptr) settings_.arm_allocations(false);
  tick_time_.add(elapsed());
}

// Another loop comes only when the live port has let go of the one before.
void Executive::swap() {
  bind_live();
  if (binding_ != nullptr || (settings_.live != nullptr && !settings_.live->rebound())) return;
  if (ControlLoop* const next = settings_.exchange->swap()) go_on(*next);
}

void Executive::go_on(ControlLoop& next) {
  loop_ = &next;
  ++exchanges_;
  if (settings_.live != nullptr) binding_ = settings_.exchange->take_binding();
  bind_live();
  for (TickObserver* const observer : observers_) observer->exchanged(next);
}

void Executive::bind_live() noexcept {
  if (binding_ != nullptr && settings_.live->rebound()) settings_.live->rebind(std::move(binding_));
}

void Executive::stop() noexcept {
  loop_->safe_stop();
  if (settings_.live != nullptr) settings_.live->stop();
}

}  // namespace footfall::engine
