// Threads whose code may never come back: scripts, functions of libraries that cannot be
// interrupted. Whoever waits for one gives up in the end and goes on without it.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace footfall::core {

// When the wait for a thread ends.
struct WatchLimits {
  double cpu = 4.0;         // s of the thread's own processor time
  double wall = 20.0;       // s
  double after_stop = 0.5;  // s of wall time once the process was told to stop (stop_on_signals())
};

class WatchedThread {
 public:
  WatchedThread() = default;
  // `work` must own, or share, all that it uses: it may outlive everything else.
  explicit WatchedThread(std::function<void()> work);
  WatchedThread(const WatchedThread&) = delete;
  WatchedThread& operator=(const WatchedThread&) = delete;
  ~WatchedThread();  // waits for the thread, unless it was let go

  // s of processor time that the thread has used. From any thread; neither allocates nor locks.
  double cpu_time() const noexcept;
  static double own_cpu_time() noexcept;  // s, of the calling thread
  // It is never waited for again. From now on threads_were_let_go().
  void let_go() noexcept;

 private:
  std::thread thread_;
};

// Waits until the thread has made `done` true and told `changed`, both under `mutex`; false if the
// limits came first.
bool wait_watched(const WatchedThread& thread, const WatchLimits& limits, std::mutex& mutex,
                  std::condition_variable& changed, const std::function<bool()>& done);

// Runs `work` on a thread of its own; false if the limits came first: it is let go then.
bool run_watched(std::function<void()> work, const WatchLimits& limits);

// Whether a thread runs that nobody waits for: the process must end by _exit().
bool threads_were_let_go() noexcept;

}  // namespace footfall::core
