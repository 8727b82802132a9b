// Clocks of threads and waits that end; see watched_thread.h.
#include "core/realtime/watched_thread.h"

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <memory>
#include <utility>

#include "core/process/stop_signals.h"

namespace footfall::core {
namespace {

using Clock = std::chrono::steady_clock;

std::atomic<bool> g_let_go{false};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double read_clock(clockid_t clock) {
  timespec time{};
  if (::clock_gettime(clock, &time) != 0) return 0.0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

WatchedThread::WatchedThread(std::function<void()> work) : thread_(std::move(work)) {}

WatchedThread::~WatchedThread() {
  if (thread_.joinable()) thread_.join();
}

double WatchedThread::cpu_time() const noexcept {
  clockid_t clock{};
  // native_handle() is not const, and does not change the thread.
  auto& thread = const_cast<std::thread&>(thread_);
  if (!thread.joinable() || ::pthread_getcpuclockid(thread.native_handle(), &clock) != 0) {
    return 0.0;
  }
  return read_clock(clock);
}

double WatchedThread::own_cpu_time() noexcept { return read_clock(CLOCK_THREAD_CPUTIME_ID); }

void WatchedThread::let_go() noexcept {
  g_let_go.store(true);
  thread_.detach();
}

bool wait_watched(const WatchedThread& thread, const WatchLimits& limits, std::mutex& mutex,
                  std::condition_variable& changed, const std::function<bool()>& done) {
  constexpr std::chrono::milliseconds kLook{5};  // how often the limits are looked at
  std::unique_lock lock(mutex);
  if (done()) return true;
  const Clock::time_point begin = Clock::now();
  const double used_before = thread.cpu_time();
  double stopped_at = -1.0;  // s after `begin`
  while (!changed.wait_for(lock, kLook, done)) {
    const double waited = seconds_since(begin);
    if (stopped_at < 0.0 && stop_flag()) stopped_at = waited;
    const bool told = stopped_at >= 0.0 && waited - stopped_at > limits.after_stop;
    if (told || waited > limits.wall || thread.cpu_time() - used_before > limits.cpu) return false;
  }
  return true;
}

bool run_watched(std::function<void()> work, const WatchLimits& limits) {
  struct End {
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
  };
  const auto end = std::make_shared<End>();
  WatchedThread thread([end, work = std::move(work)] {
    work();
    const std::lock_guard lock(end->mutex);
    end->done = true;
    end->changed.notify_all();
  });
  if (wait_watched(thread, limits, end->mutex, end->changed, [&end] { return end->done; })) {
    return true;
  }
  thread.let_go();
  return false;
}

bool threads_were_let_go() noexcept { return g_let_go.load(); }

}  // namespace footfall::core
