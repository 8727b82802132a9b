// The script of a scenario while it runs: waits for each entry's moment and does what it says,
// between two ticks: live edits through the loop's door, the rest through hooks, since what pushes
// or holds a robot is the backend's.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/tick/control_loop.h"
#include "lab/judge/lua.h"
#include "lab/judge/result.h"
#include "lab/run/run.h"
#include "lab/run/run_log.h"
#include "lab/scenario/description.h"

namespace footfall::lab {

// What only the world around the robot can do. A hook that is missing cannot be asked for: see
// unsupported().
struct ScenarioHooks {
  // A force on a body for a time; false: not now.
  std::function<bool(const std::string& body, const ScriptedPush& push)> push;
  // People hold a body where it is; the number of the hold, negative: not now.
  std::function<int(const model::BodySprings& hold)> hold;
  // They let go.
  std::function<void(int number)> release;
  // Sensors fail, or come back.
  std::function<void(InjectedFault fault, bool on)> fault;
};

// What of the script these hooks cannot do, as texts FILE:LINE:COLUMN: error: ...; empty: all can.
std::vector<std::string> unsupported(const ScenarioDescription& scenario,
                                     const ScenarioHooks& hooks);

class ScenarioCues {
 public:
  // All must outlive it. seed: of the run.
  ScenarioCues(const ScenarioDescription& scenario, const ScenarioHooks& hooks,
               engine::ControlLoop& loop, std::uint64_t seed);

  // Before each tick: what is due.
  void fire(const StepClock& steps, RunLog& log);
  // After each tick's compute(): events and states that entries wait for.
  void observe();
  // Entries that could not be done at their moment, each once.
  const std::vector<ScenarioFailure>& problems() const { return problems_; }
  // Entries whose moment never came, without the optional ones.
  std::vector<ScenarioFailure> missed() const;

 private:
  struct Cue {
    const ScriptEntry* entry = nullptr;
    bool done = false;         // at least once
    std::vector<bool> events;  // by event: fires at it
    int heard = 0;             // events of the last tick
  };
  // A state that some entry waits for a phase of.
  struct Watched {
    int state = 0;
    int timer = -1;  // its last event-less transition with `after`
    std::uint32_t entries = 0;
    bool active = false;
    std::int64_t entered = 0;
    std::int64_t duration = -1;  // ticks, planned at entry, else of the last visit; -1: unknown
  };
  struct Lasting {
    std::int64_t until = 0;             // tick
    const ScriptEntry* hold = nullptr;  // null: a fault
    int number = -1;                    // of the hold
    InjectedFault fault = InjectedFault::mocap_dropout;
  };

  void watch(const Moment& moment);
  bool due(const Cue& cue, const StepClock& steps) const;
  bool in_phase(const Moment& moment) const;
  void act(const ScriptEntry& entry, RunLog& log);
  void submit(const ScriptEntry& entry, const std::vector<behaviors::SlotValue>& values,
              engine::EditSource source, RunLog& log);
  void hand_in(const ScriptEntry& entry, const engine::EditBatch& batch, RunLog& log);
  void call(const ScriptEntry& entry, RunLog& log);
  void hold(const ScriptEntry& entry, std::int64_t until, RunLog& log);
  void inject(InjectedFault fault, bool on);
  void end_lasting(RunLog& log);
  std::int64_t ticks_of(double seconds) const;
  void add_problem(const ScriptEntry& entry, const std::string& text);
  std::string place_of(const ScriptEntry& entry) const;

  const ScenarioDescription& scenario_;
  const ScenarioHooks& hooks_;
  engine::ControlLoop& loop_;
  std::vector<Cue> cues_;
  std::vector<Watched> watched_;
  std::vector<Lasting> lasting_;
  std::array<int, kInjectedFaultCount>
      failing_{};                   // by InjectedFault: entries that have it fail now
  std::optional<ScenarioLua> lua_;  // if some entry calls
  std::vector<ScenarioFailure> problems_;
};

}  // namespace footfall::lab
