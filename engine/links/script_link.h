// Between the tick and a behavior's scripts: what a tick asks goes with a snapshot of the robot to
// a thread that runs Lua, what the scripts want comes back at the start of a later tick. The tick
// never waits: when the scripts fall behind, requests are dropped and counted. In lock-step the
// caller waits between two ticks, so the answer is always there in the next one, and runs repeat.
// In a paced run the thread has the lowest priority, and may hold a lock for as long as others want
// its processor: the run's thread takes none of its locks.
// A script that does not come back is given up: the fault script.stuck, and no script any more.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "behaviors/machine/machine.h"
#include "behaviors/script/watched.h"
#include "core/realtime/ring.h"
#include "core/realtime/watched_thread.h"

namespace footfall::engine {

class ScriptLink {
 public:
  // Loads the behavior's scripts anew and starts the thread. Throws std::runtime_error if they do
  // not load with this access. The behavior must outlive this. paced: wait() is never called.
  ScriptLink(const behaviors::Behavior& behavior, const behaviors::ScriptSettings& settings,
             bool paced);
  ~ScriptLink();
  ScriptLink(const ScriptLink&) = delete;
  ScriptLink& operator=(const ScriptLink&) = delete;

  // In the tick. Applies what the scripts answered since the last tick.
  void deliver(behaviors::Machine& machine) noexcept;
  // Posts this tick's requests; false: some were dropped.
  bool post(const behaviors::Machine& machine, const double* signals, double time) noexcept;
  // After post(), with s of a tick: whether the scripts were given up. They are if the call under
  // way has used its processor time (behaviors::watch_limits()), or has blocked for the bound in
  // wall time, counted in ticks: no script runs any more. Reads a clock only once as many ticks as
  // its processor time have gone by.
  bool stuck(double period) noexcept;

  // Outside of the tick. Waits until everything posted is answered (lock-step), or gives up.
  void wait() noexcept;
  // Texts logged by scripts and their errors since the last call. Waits for nothing. To be called
  // once a tick: of more than kTexts batches the later texts are lost, and their number is told.
  std::vector<std::string> take_messages();

 private:
  static constexpr std::uint32_t kBatches = 16;  // ticks with requests that may wait
  static constexpr std::size_t kRequests = 64;   // of one tick
  static constexpr std::size_t kAnswers = 256;   // events or edits of one tick's requests
  // Batches whose texts nobody took: between two ticks kBatches and one more are answered.
  static constexpr std::size_t kTexts = 2UL * kBatches;
  using Texts = std::vector<std::string>;

  // One tick's requests with the robot at that time, then the answer. Used in turn.
  struct Batch {
    double time = 0.0;
    std::size_t request_count = 0;
    std::array<behaviors::ScriptRequest, kRequests> requests{};
    std::vector<double> signals, parameters;
    std::vector<std::uint8_t> active;
    std::size_t event_count = 0, edit_count = 0;
    std::array<int, kAnswers> events{};
    std::array<behaviors::SlotValue, kAnswers> edits{};
  };

  // What the thread uses. Shared with it, because it may outlive the link.
  struct Side {
    Side(const behaviors::Behavior& behavior, const behaviors::ScriptSettings& settings);
    void work() noexcept;
    void answer(Batch& batch);
    void begin_call() noexcept;
    void tell(Texts said);
    Batch& batch(std::uint32_t number) noexcept { return batches[number % kBatches]; }

    const behaviors::Behavior* behavior;  // not looked at once the script was stopped
    std::vector<std::string> events, calls;
    std::shared_ptr<behaviors::Script> script;
    std::vector<Batch> batches;
    // Numbers of batches, modulo 2^32: delivered <= answered <= posted <= delivered + kBatches.
    std::atomic<std::uint32_t> posted{0}, answered{0};
    std::atomic<bool> stop{false}, ended{false};
    std::atomic<std::uint32_t> begun{0};   // calls
    std::atomic<double> used_before{0.0};  // s, the thread's processor time as the last one began
    std::mutex mutex;                      // of `ended` and `answered`, for wait_for()
    std::condition_variable came;
    // Texts from the thread, and back to it once they were read: the run's thread would wait for a
    // lock of malloc() if it freed them.
    core::Ring<Texts> texts{kTexts}, read_texts{kTexts};
    std::size_t lost = 0;  // texts, of the thread
  };

  bool wait_for(const std::function<bool()>& done) noexcept;
  void give_up() noexcept;

  std::shared_ptr<Side> side_;
  std::uint32_t delivered_ = 0;  // of the tick
  std::uint32_t begun_ = 0;      // calls, as seen by the last tick
  std::int64_t unanswered_ = 0;  // ticks since the last answer or call, while answers are missing
  std::atomic<bool> given_up_{false};
  bool let_go_ = false;  // its thread, which may never end
  bool told_given_up_ = false;
  core::WatchLimits limits_;  // of a call
  core::WatchedThread thread_;
};

}  // namespace footfall::engine
