// Runs the tick again on what a log has: its files, inputs, planners' answers and edits. Nothing
// else reaches it, so it is what the run was, bit for bit, as long as program and files are the
// same.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lab/log/reader.h"

namespace footfall::behaviors {
struct Behavior;
}
namespace footfall::engine {
class ControlLoop;
}

namespace footfall::lab {

class Replay {
 public:
  // log: read with all_rows and inputs; it must outlive the replay. behavior_file: instead of the
  // log's own, empty for that. Throws std::runtime_error: no inputs, files that do not load (all
  // their messages).
  explicit Replay(const Log& log, const std::string& behavior_file = "");
  ~Replay();
  // The run goes on in the log of its next reload, which must outlive the replay, too. Throws
  // std::runtime_error: it does not begin where this one ends, or as the constructor.
  void go_on(const Log& next);
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  // Ticks that there are inputs for in the log it is in; the next one to run.
  std::int64_t end() const;
  std::int64_t next() const;
  // The next tick. after: called when control is computed and before anything moves on;
  // before_machine: just before the behavior's part of the tick. Either may be empty.
  void tick(const std::function<void()>& after, const std::function<void()>& before_machine = {});

  const behaviors::Behavior& behavior() const;
  const engine::ControlLoop& loop() const;
  std::string state() const;  // paths of the active atomic states
  // What the planners computed in this tick's place, if it is not what was logged; else empty.
  std::vector<std::string> plan_differences() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Where a replay parts from its log.
struct ReplayReport {
  std::int64_t ticks = 0;               // that were compared
  std::vector<std::string> parameters;  // that are not as logged: `NAME: X in the log, Y now`
  std::int64_t differs_at = -1;         // tick; -1: nowhere
  double time = 0.0;                    // s
  std::string state;
  std::vector<std::string> lines;  // what differs there
  std::int64_t visible_at = -1;    // where `lines` are from: a later tick if floats hide it
};

// Runs to the end, or a little past the first difference. Each tick: the digest of all signals (if
// the behavior has the same), commands bit for bit, planners' answers, logged rows.
ReplayReport verify_replay(const Log& log, Replay& replay);

}  // namespace footfall::lab
