// clock_nanosleep pacing; see pacer.h.
#include "engine/realtime/pacer.h"

#include <time.h>

#include <cmath>

namespace footfall::engine {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

std::int64_t now_ns() noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kNsPerSecond + t.tv_nsec;
}

}  // namespace

Pacer::Pacer(double period_s) : period_ns_(std::llround(period_s * 1e9)) {}

bool Pacer::wait() noexcept {
  const std::int64_t now = now_ns();
  if (next_ns_ == 0) next_ns_ = now;
  next_ns_ += period_ns_;
  if (next_ns_ <= now) {
    next_ns_ += (now - next_ns_) / period_ns_ * period_ns_;  // the last one that passed
    return false;
  }
  const timespec until = {next_ns_ / kNsPerSecond, next_ns_ % kNsPerSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) {
  }
  return true;
}

}  // namespace footfall::engine
