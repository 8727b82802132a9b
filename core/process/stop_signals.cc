// The flag and its handlers; see stop_signals.h.
#include "core/process/stop_signals.h"

#include <unistd.h>

#include <csignal>

namespace footfall::core {
namespace {

constexpr unsigned kLastWords = 1;  // s from the second signal to the end

std::atomic<bool> g_stop{false};
std::atomic<int> g_second{0};                           // number of the second signal
static_assert(std::atomic<bool>::is_always_lock_free);  // signal handlers write them
static_assert(std::atomic<int>::is_always_lock_free);

void on_alarm(int /*number*/) { ::_exit(128 + g_second.load()); }

void on_signal(int number) {
  if (!g_stop.exchange(true)) return;
  int none = 0;
  if (g_second.compare_exchange_strong(none, number)) ::alarm(kLastWords);
}

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigaction(number, &action, nullptr);
}

bool ignored(int number) {
  struct sigaction now {};
  return ::sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

const std::atomic<bool>* stop_on_signals() noexcept {
  handle(SIGALRM, on_alarm);
  handle(SIGINT, on_signal);
  handle(SIGTERM, on_signal);
  if (!ignored(SIGHUP)) handle(SIGHUP, on_signal);
  return &g_stop;
}

bool stop_flag() noexcept { return g_stop.load(); }

}  // namespace footfall::core
