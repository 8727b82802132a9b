// What reaches the machine from outside of the tick and what leaves it: planners' answers, scripts,
// and the trace of both for the log and for replays. In: deliver(). Out: post().
#pragma once

#include <memory>

#include "behaviors/machine/machine.h"
#include "engine/links/planner_link.h"
#include "engine/links/script_link.h"
#include "engine/tick/faults.h"
#include "engine/tick/input_trace.h"
#include "engine/tick/settings.h"

namespace footfall::engine {

class Outside {
 public:
  // Loads the behavior's scripts. Throws std::runtime_error if they do not load.
  Outside(const behaviors::Behavior& behavior, const LoopSettings& settings);

  // Before start(). What comes in goes to `trace`, which must outlive this.
  void record(InputTrace& trace);
  // Before start(). What comes in is taken from `trace`; planners' answers of their own are only
  // noted (InputTrace::planned).
  void play(InputTrace& trace);
  bool playing() const noexcept { return playing_; }

  // After the machine's start.
  void start(const behaviors::Machine& machine) noexcept;
  // Before sense(): whether the next tick begins late.
  void late(bool late) noexcept { late_ = late; }
  // Before the machine's tick. edited: an edit moves values in this tick, or the command has not
  // caught up with one yet. Returns whether this tick began late.
  bool deliver(std::int64_t tick, behaviors::Machine& machine, bool edited) noexcept;
  // After the machine's tick; finds event.overflow if requests of scripts were dropped, and
  // script.stuck. time: s since start.
  FaultFindings post(std::int64_t tick, const behaviors::Machine& machine,
                     const core::SignalTable& signals, double time) noexcept;
  // Outside of the tick: in lock-step, until scripts have answered all that was posted.
  void wait() noexcept;

  // Whether torque steps are limited in this tick: an edit acts on the command.
  bool limit_steps() const noexcept { return limit_steps_; }
  void drop_planners(bool on) noexcept { planners_.drop(on); }
  ScriptLink* scripts() noexcept { return scripts_.get(); }  // nullptr: the behavior has none

  // Goes on from another loop's; what is under way there is lost. `machine` has taken over.
  void take_over(const Outside& old, const behaviors::Machine& machine) noexcept;

 private:
  void replay(std::int64_t tick, behaviors::Machine& machine) noexcept;

  const behaviors::Behavior& behavior_;
  PlannerLink planners_;
  std::unique_ptr<ScriptLink> scripts_;
  bool lockstep_;
  WriteWatch watch_;
  InputTrace* trace_ = nullptr;
  bool playing_ = false;
  bool late_ = false;
  bool taken_over_ = false;  // since the last tick
  bool limit_steps_ = false;
};

}  // namespace footfall::engine
