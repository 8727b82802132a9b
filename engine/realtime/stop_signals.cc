// The flag and its handler; see stop_signals.h.
#include "engine/realtime/stop_signals.h"

#include <csignal>

namespace footfall::engine {
namespace {

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // a signal handler writes it

void on_signal(int /*number*/) { g_stop.store(true); }

}  // namespace

const std::atomic<bool>* stop_on_signals() noexcept {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  return &g_stop;
}

}  // namespace footfall::engine
