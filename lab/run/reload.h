// Reloads of a run: a candidate is prepared beside it, waits for its moment, takes over between two
// ticks, is on probation for a while and taken back on a fault. Each behavior that ran has a log of
// its own: DIR/log.mcap, DIR/reload-1/log.mcap, ...
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/realtime/ring.h"
#include "engine/edits/door.h"
#include "engine/realtime/executive.h"
#include "lab/run/reload_candidate.h"

namespace footfall::lab {

inline constexpr std::size_t kMostReloadText = 500;
using ReloadText = engine::FixedText<kMostReloadText>;

// An event `reload` of the log.
struct ReloadNews {
  engine::FixedText<16> what;
  ReloadText detail;
};

// Two threads: the one that ticks, and one beside it that loads, opens logs, tells and frees. They
// meet at a mutex that the beside holds only to exchange pointers and the tick only tries.
class Reloads final : public engine::LoopExchange {
 public:
  // `first` runs; its behavior and what `setup` points to must outlive this.
  Reloads(engine::ControlLoop& first, ReloadSetup setup);
  ~Reloads() override;
  Reloads(const Reloads&) = delete;
  Reloads& operator=(const Reloads&) = delete;

  // --- The thread beside the run. ---
  // Loads `path` and offers it to the run, in the place of what was offered and still waits.
  // Returns the files that it is made of.
  std::vector<std::string> request(const std::string& path);
  // To be called now and then: tells what became of reloads, frees what nobody uses any more,
  // prepares what had to wait for the end of a probation.
  void tend();
  // After the run: tend(), and ends the logs. Throws std::runtime_error if one of them failed.
  void close();

  // --- The thread that ticks. ---
  engine::ControlLoop* swap() override;
  engine::ControlLoop* take_back() override;
  std::unique_ptr<engine::LiveBinding> take_binding() override;
  // The log's side of the loop that swap() or take_back() returned last.
  RunLog& log() noexcept { return *now_->outputs->log; }
  // The next event for the log that is written now; false: none.
  bool take_news(ReloadNews& news) noexcept;
  // What a status line tells of a reload that waits; empty: none does.
  std::string note();

 private:
  // From the tick, for people.
  struct Report {
    ReloadText line;
    RunOutputs* used = nullptr;  // outputs that came into use
  };

  void hand_over() noexcept;
  void complain_once() noexcept;
  void tell_from_tick(const char* what, std::string_view detail, std::string_view line) noexcept;
  void arm(ReloadCandidate& running, int done);
  void refuse(const ReloadCandidate& candidate);
  void drop_offer();
  void retire(std::unique_ptr<ReloadCandidate> stage);
  void close_outputs(RunOutputs* outputs);

  const ReloadSetup setup_;
  const FileDigests robot_;

  // --- Of the thread beside. ---
  std::unique_ptr<ReloadCandidate> loaded_;  // cannot be armed yet
  std::string failure_;                      // of the first log that could not be written

  // --- Behind the mutex. ---
  std::mutex meeting_;
  std::unique_ptr<ReloadCandidate> offer_;  // armed
  std::unique_ptr<ReloadCandidate> retired_;
  std::unique_ptr<RunOutputs> unused_;
  std::shared_ptr<const behaviors::Behavior> running_;
  bool settled_ = true;  // no probation: now_ is what it is until an offer takes over

  // --- Between the threads, without it. ---
  std::atomic<bool> waits_{false};  // for the end of a probation
  core::Ring<Report> reports_{16};
  core::Ring<ReloadNews> refusals_{16};

  // --- Of the tick; now_ also of the thread beside, while settled_. ---
  std::unique_ptr<ReloadCandidate> now_;
  std::unique_ptr<ReloadCandidate> former_;  // that a fault brings back; nullptr: no probation
  std::unique_ptr<ReloadCandidate> failed_;  // taken back, not handed over yet
  std::int64_t proven_at_ = 0;               // tick at which the probation ends
  core::Ring<ReloadNews> news_{8};
  int done_ = 0;  // loops that took over, those taken back too
};

}  // namespace footfall::lab
