// A scenario as its `scenario: 1` file says: which behavior runs on which robot in which world,
// what happens to it from outside, and what is expected of it. Load time only.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "behaviors/expression/statistics.h"
#include "core/diagnostics/diagnostics.h"
#include "core/signal_table.h"

namespace footfall::lab {

// When an entry of the script happens: at a time, at a place in the run, or on an event.
struct Moment {
  enum class Kind : std::uint8_t { time, place, event };
  Kind kind = Kind::time;
  double time = 0.0;        // s
  std::int64_t step = 0;    // from 1; 0: any
  std::vector<int> states;  // any of these is active (left and right); empty: any
  double phase = 0.0;       // of the state's, else the step's duration: 0 up to below 1
  std::string event;        // name or prefix (`fault.*`)
};

// A constant horizontal force on a body's centre of mass.
struct ScriptedPush {
  std::string body;        // empty: the floating base
  double force = 0.0;      // N
  double duration = 0.0;   // s
  double direction = 0.0;  // rad in the heading frame, 0 forward, pi/2 left
};

enum class InjectedFault : std::uint8_t {
  mocap_dropout,
  imu_dropout,
  sensor_dropout,
  planner_dropout,
};

struct ScriptEntry {
  core::Mark mark;
  Moment moment;
  std::optional<ScriptedPush> push;
  std::vector<behaviors::SlotValue> edit;  // with `raise`, as one live edit
  double over = 0.0;                       // s, ramp of the edit
  std::vector<behaviors::SlotValue> set;
  int raise = -1;  // into Behavior::events
  std::optional<InjectedFault> fault;
  std::string hold;                // a body; empty: none
  std::string call;                // a function of ScenarioDescription::scripts; empty: none
  std::optional<double> duration;  // s, of fault or hold; none: to the end
};

// A statistic of a signal over the time that is judged.
struct SignalStatistic {
  const behaviors::Statistic* statistic = nullptr;
  bool magnitude = false;  // of |signal|
  int signal = 0;          // into ScenarioDescription::signals
  int value = 0;           // the signal that holds it, likewise
};

struct Expectation {
  enum class Kind : std::uint8_t { that, never, sequence, end };
  core::Mark mark;
  Kind kind = Kind::that;
  int expression = -1;      // into ScenarioDescription::expressions
  std::vector<int> states;  // of the sequence
  std::vector<int> ends;    // into kScenarioEnds: any of them
  bool timed = false;       // a time in which it is judged was written
  double from = 0.0;        // s, judged from here
  std::optional<double> to;
  std::optional<double> within;  // s
  double part = 1.0;             // of the seeds in which it must hold
  std::string text;              // as written
};

// A recorded trace that a run must follow.
struct GoldenSignal {
  int signal = 0;          // into Behavior::signals
  double tolerance = 0.0;  // SI
};
struct GoldenSpec {
  core::Mark mark;
  std::string path;    // of the CSV file
  double rate = 50.0;  // Hz, of its rows
  std::vector<GoldenSignal> signals;
};

struct ScenarioDescription {
  std::string name, doc, path;
  std::vector<std::string> labels;
  std::string behavior_name, behavior_path;
  std::string robot;           // name or path as written; empty: the behavior's
  std::string world = "flat";  // name or path as written
  core::Mark world_mark;       // no line: not written
  std::vector<std::uint64_t> seeds{1};
  double duration = 0.0;  // s
  std::vector<ScriptEntry> script;
  std::vector<behaviors::ScriptFile> scripts;
  std::vector<Expectation> expectations;
  std::optional<GoldenSpec> golden;
  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;  // the behavior's, then `steps` and those of the statistics
  std::vector<SignalStatistic> statistics;
  behaviors::ExpressionPool expressions;
  std::vector<std::string> files;           // by core::Mark::file of what the scenario says
  std::vector<std::string> behavior_files;  // likewise of what its behavior says
};

}  // namespace footfall::lab
