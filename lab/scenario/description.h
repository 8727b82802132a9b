// A scenario of a `scenario: 1` file: which behavior runs on which robot in which world, external
// events, and expectations. Load time only.
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
#include "core/yaml/yaml.h"
#include "model/aids/springs.h"

namespace footfall::lab {

inline constexpr std::int64_t kMostSeeds = 100'000;  // of a scenario or a command

// Trigger of a script entry: a time, a place in the run, or an event.
struct Moment {
  enum class Kind : std::uint8_t { time, place, event };
  Kind kind = Kind::time;
  double time = 0.0;        // s
  std::int64_t step = 0;    // from 1; 0: any
  std::vector<int> states;  // at least one of these is active (left and right); empty: any
  double phase = 0.0;       // fraction of the state's duration, else of the step's: [0, 1)
  std::string event;        // name or prefix (`fault.*`)
};

// A constant force on a body.
struct ScriptedPush {
  std::string body;        // empty: the floating base
  double force = 0.0;      // N
  double duration = 0.0;   // s
  double direction = 0.0;  // rad in the heading frame, 0 forward, pi/2 left
  double elevation = 0.0;  // rad, above the horizontal: pi/2 upwards
  // Of the body's frame, m, where it acts; nullopt: its centre of mass.
  std::optional<std::array<double, 3>> point;
};

enum class InjectedFault : std::uint8_t {
  mocap_dropout,
  imu_dropout,
  sensor_dropout,
  planner_dropout,
  imu_freeze,
  mocap_freeze,
  led_loss,
};
inline constexpr std::size_t kInjectedFaultCount = 7;

struct ScriptEntry {
  core::Mark mark;
  Moment moment;
  std::optional<ScriptedPush> push;
  std::vector<behaviors::SlotValue> edit;  // applied as one live edit together with `raise`
  double over = 0.0;                       // s, ramp duration of the edit
  std::vector<behaviors::SlotValue> set;
  int raise = -1;  // into Behavior::events
  std::optional<InjectedFault> fault;
  std::optional<model::BodySprings> hold;
  std::string call;                // function of ScenarioDescription::scripts to call; empty: none
  std::optional<double> duration;  // s, of a fault or hold; nullopt: to the end
  bool optional = false;           // the run may end before it comes
};

// A statistic of a signal over the judged time.
struct SignalStatistic {
  const behaviors::Statistic* statistic = nullptr;
  bool magnitude = false;  // of the magnitude |signal|
  int signal = 0;          // into ScenarioDescription::signals
  int value = 0;           // index of the signal that holds the result, likewise
};

struct Expectation {
  enum class Kind : std::uint8_t { that, never, sequence, end };
  core::Mark mark;
  Kind kind = Kind::that;
  int expression = -1;      // into ScenarioDescription::expressions
  std::vector<int> states;  // of a sequence
  std::vector<int> ends;    // indices into kScenarioEnds, alternatives
  bool timed = false;       // a time window is given
  double from = 0.0;        // s, start of the window
  std::optional<double> to;
  std::optional<double> within;  // s
  double part = 1.0;             // fraction of seeds in which it must hold
  std::string text;              // as written
};

// One signal of a golden trace that a run must follow.
struct GoldenSignal {
  int signal = 0;          // into Behavior::signals
  double tolerance = 0.0;  // SI
};
struct GoldenSpec {
  core::Mark mark;
  std::string path;    // path of the CSV file
  double rate = 50.0;  // Hz, row rate
  std::vector<GoldenSignal> signals;
};

struct ScenarioDescription {
  std::string name, doc, path;
  std::vector<std::string> labels;
  std::string behavior_name, behavior_path;
  std::string robot;           // name or path as written; empty: the behavior's robot
  std::string world = "flat";  // name or path as written
  core::Mark world_mark;       // line 0 if not written
  std::string world_from;      // the file that names it, the scenario's or a base's
  // `variation:`, over the world's (model::read_variation); it was read once without problems.
  std::optional<core::YamlNode> variation;
  std::vector<std::uint64_t> seeds{1};
  core::Mark seeds_mark;      // line 0 if not written
  bool scripts_draw = false;  // its scripts or those of its behavior use random numbers
  double duration = 0.0;      // s
  core::Mark duration_mark;
  std::vector<ScriptEntry> script;
  std::vector<behaviors::ScriptFile> scripts;
  std::vector<Expectation> expectations;
  std::optional<GoldenSpec> golden;
  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;  // the behavior's, then `steps` and those of the statistics
  std::vector<SignalStatistic> statistics;
  behaviors::ExpressionPool expressions;
  std::vector<std::string> files;           // files of its positions, by core::Mark::file
  std::vector<std::string> behavior_files;  // of its behavior's positions
};

}  // namespace footfall::lab
