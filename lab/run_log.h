// Writes a run into its log: rows at the chosen rate, and an event for each transition, mark, step,
// plan and fault. Lock-step: called after the tick, outside its timing.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/control_loop.h"
#include "engine/log_writer.h"
#include "lab/step_counter.h"

namespace footfall::lab {

class RunLog {
 public:
  using Said = std::function<void(double time, const std::string& text)>;
  // log may be null: then only state_name() does anything, and `said`, if there is one, is told
  // what `log:` actions and scripts say.
  RunLog(engine::ControlLoop& loop, engine::LogWriter* log, int every, Said said = nullptr);
  void after_tick(const StepEvent& step);
  void event(std::string_view kind, std::string_view name, std::string_view detail);
  std::string state_name() const;

 private:
  std::int64_t time_ns() const;
  void write_texts();
  void say(const std::string& text, std::string_view from);
  engine::ControlLoop& loop_;
  engine::LogWriter* log_;
  int every_;
  Said said_;
  core::FaultCounters seen_faults_;
  std::vector<std::array<double, 3>> last_targets_;
};

// The log's header: behavior, robot, world, seed, states, model.
engine::LogHeader make_log_header(const behaviors::Behavior& behavior, const std::string& world,
                                  const std::string& backend, std::uint64_t seed);

}  // namespace footfall::lab
