// Between the tick and a behavior's scripts: what a tick asks goes with a snapshot of the robot to
// a thread that runs Lua, what the scripts want comes back at the start of a later tick. The tick
// never waits: when the scripts fall behind, requests are dropped and counted. In lock-step the
// caller waits between two ticks, so the answer is always there in the next one, and runs repeat.
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
#include "core/realtime/watched_thread.h"

namespace footfall::engine {

class ScriptLink {
 public:
  // Loads the behavior's scripts anew and starts the thread. Throws std::runtime_error if they do
  // not load with this access. The behavior must outlive this.
  ScriptLink(const behaviors::Behavior& behavior, const behaviors::ScriptSettings& settings);
  ~ScriptLink();
  ScriptLink(const ScriptLink&) = delete;
  ScriptLink& operator=(const ScriptLink&) = delete;

  // In the tick. Applies what the scripts answered since the last tick.
  void deliver(behaviors::Machine& machine) noexcept;
  // Posts this tick's requests; false: some were dropped.
  bool post(const behaviors::Machine& machine, const double* signals, double time) noexcept;
  // Whether the scripts were given up, or should be: `ticks` ticks came since the oldest request
  // that has no answer.
  bool stuck(std::int64_t ticks) noexcept;

  // Outside of the tick. Waits until everything posted is answered (lock-step), or gives up.
  void wait() noexcept;
  // Texts logged by scripts and their errors since the last call.
  std::vector<std::string> take_messages();

 private:
  static constexpr std::uint32_t kBatches = 16;  // ticks with requests that may wait
  static constexpr std::size_t kRequests = 64;   // of one tick
  static constexpr std::size_t kAnswers = 256;   // events or edits of one tick's requests

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
    Batch& batch(std::uint32_t number) noexcept { return batches[number % kBatches]; }

    const behaviors::Behavior* behavior;  // not looked at once the script was stopped
    std::vector<std::string> events, calls;
    std::shared_ptr<behaviors::Script> script;
    std::vector<Batch> batches;
    // Numbers of batches, modulo 2^32: delivered <= answered <= posted <= delivered + kBatches.
    std::atomic<std::uint32_t> posted{0}, answered{0};
    std::atomic<bool> stop{false}, ended{false};
    std::mutex mutex;  // never taken in the tick
    std::condition_variable came;
    std::vector<std::string> messages;
  };

  bool wait_for(const std::function<bool()>& done) noexcept;
  void give_up() noexcept;

  std::shared_ptr<Side> side_;
  std::uint32_t delivered_ = 0;  // of the tick
  std::int64_t unanswered_ = 0;  // ticks since the last answer, while some are missing
  std::atomic<bool> given_up_{false};
  core::WatchedThread thread_;
};

}  // namespace footfall::engine
