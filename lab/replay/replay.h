// Repeats the ticks of a run from its log: files, inputs, planners' answers and edits. There are no
// other inputs, so with the same program and files the result is bit-identical to the run.
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
  // log: read with all_rows and inputs; must outlive the replay. behavior_file: replaces the log's
  // own behavior; empty to keep it. Throws std::runtime_error if there are no inputs or the files
  // do not load (with all their messages).
  explicit Replay(const Log& log, const std::string& behavior_file = "");
  ~Replay();
  // Continues with the log of the run's next reload, which must outlive the replay, too. Throws
  // std::runtime_error if it does not begin where this one ends, or like the constructor.
  void go_on(const Log& next);
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  // Number of ticks with inputs in the current log; the next tick to run.
  std::int64_t end() const;
  std::int64_t next() const;
  // Runs the next tick. after: called after control is computed and before the simulation advances;
  // before_machine: called just before the behavior's part of the tick. Either may be empty.
  void tick(const std::function<void()>& after, const std::function<void()>& before_machine = {});

  const behaviors::Behavior& behavior() const;
  const engine::ControlLoop& loop() const;
  std::string state() const;  // paths of the active atomic states
  // Differences between the logged plans of this tick and those computed now; empty if equal.
  std::vector<std::string> plan_differences() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Result of comparing a replay with its log.
struct ReplayReport {
  std::int64_t ticks = 0;               // number of ticks compared
  std::vector<std::string> parameters;  // different ones: `NAME: X in the log, Y now`
  std::int64_t differs_at = -1;         // tick of the first difference, -1 if none
  double time = 0.0;                    // s
  std::string state;
  std::vector<std::string> lines;  // differences at that tick
  std::int64_t visible_at = -1;  // of `lines`: later than differs_at if floats hide the difference
};

// Runs to the end, or slightly beyond the first difference. Compares for each tick the digest of
// all signals (if the behavior has the same signals), commands bit for bit, planners' answers, and
// logged rows.
ReplayReport verify_replay(const Log& log, Replay& replay);

}  // namespace footfall::lab
