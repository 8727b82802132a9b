// Reloads of a run: a candidate waits for its moment, takes over between two ticks, is on probation
// for a while and taken back on a fault. Each behavior that ran has a log of its own:
// DIR/log.mcap, DIR/reload-1/log.mcap, ...
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "lab/run/reload_candidate.h"

namespace footfall::lab {

// The log of a run's reload, 1 being its first.
std::string reload_log(const std::string& folder, int number);

class Reloads {
 public:
  // `first` runs; its behavior, `setup.hardware` and `log` (null: none) must outlive this.
  Reloads(engine::ControlLoop& first, engine::LogWriter* log, ReloadSetup setup);
  ~Reloads();
  Reloads(const Reloads&) = delete;
  Reloads& operator=(const Reloads&) = delete;

  // --- Any one thread. --- Loads `path` beside the run and offers it, in the place of what was
  // offered and still waits. Returns the files that it is made of.
  std::vector<std::string> request(const std::string& path);

  // --- The thread that ticks. ---
  // Between two ticks. True: now() is another loop, log() another log.
  bool swap();
  // After compute(), before actuate(). True: the tick has shown a fault of a reload on probation,
  // and now() is the loop that ran before: its compute() is to be called on the same tick.
  bool take_back();
  engine::ControlLoop& now() noexcept { return *now_.loop; }
  engine::LogWriter* log() noexcept { return now_.log; }
  // What became of reloads since the last call, for the log: {what, detail}.
  std::vector<std::pair<std::string, std::string>> take_news();
  // What is to be known of one that waits; empty: none does.
  std::string note() const;
  int done() const noexcept { return done_; }  // swaps, those back too
  // Ends the logs that this wrote. Throws std::runtime_error if one of them failed.
  void close();

 private:
  struct Stage {
    std::shared_ptr<const behaviors::Behavior> behavior;
    std::unique_ptr<engine::ControlLoop> own;
    engine::ControlLoop* loop = nullptr;
    engine::LogWriter* log = nullptr;
    engine::LogHeader header;  // for going on after being taken back
  };

  void set_running(Stage& retired);
  void take_offer();
  void judge_waiting();
  void complain_once();
  engine::LogWriter* open_log(const engine::LogHeader& header, const behaviors::Behavior& behavior,
                              bool back);
  void say(const std::string& what, const std::string& detail, const std::string& line);

  ReloadSetup setup_;
  FileDigests robot_;
  std::mutex running_mutex_;  // taken at swaps, never in a tick
  std::shared_ptr<const behaviors::Behavior> running_;
  std::atomic<ReloadCandidate*> offered_{nullptr};
  std::unique_ptr<ReloadCandidate> waiting_;
  std::int64_t waits_since_ = 0;  // tick
  bool complained_ = false;
  Stage now_, before_;           // before_.loop: what a fault brings back; null: no probation
  Stage failed_;                 // that was taken back in the last tick
  std::vector<Stage> retired_;   // behind running_mutex_: to be freed by the thread that loads
  behaviors::TakeOverMap back_;  // from now_ to before_
  std::int64_t proven_at_ = 0;   // tick at which the probation ends
  std::string path_;             // of what is on probation
  std::vector<std::unique_ptr<engine::LogWriter>> logs_;
  std::vector<std::pair<std::string, std::string>> news_;
  int done_ = 0;
};

}  // namespace footfall::lab
