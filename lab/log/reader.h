// Reads the log of a run (engine/log/writer.h), complete or truncated at any byte; everything
// before the cut is returned. After a run, for reports, comparisons, replay and tests.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/tick/input_row.h"

namespace footfall::lab {

struct LoggedSignal {
  std::string name;  // dotted, e.g. com.pos.z
  std::string unit;  // SI; empty for a plain number
  std::string doc;
};

struct LoggedEvent {
  double time = 0.0;  // s
  std::string kind;   // transition, mark, fault, plan, step, ...
  std::string name;
  std::string detail;
  std::int64_t tick = 0;
};

// A planner's answer as it was delivered to the behavior.
struct LoggedPlan {
  std::int64_t tick = 0;
  int planner = 0;
  std::uint32_t sequence = 0;
  bool ok = false;
  std::array<double, 3> target{};         // m, world
  std::array<double, 2> predicted_pos{};  // m, world
  std::array<double, 2> predicted_vel{};  // m/s, world
  double extension = 0.0;                 // s
};

// External changes of parameters and external events just before a tick of the behavior.
struct LoggedEdit {
  std::int64_t tick = 0;
  std::vector<std::pair<int, double>> writes;  // slots and their new values
  std::vector<int> events;                     // into Log::event_names
  bool limit_steps = false;                    // torque steps were limited in this tick
  bool late = false;                           // the tick began late
  bool requests_lost = false;                  // of scripts, whose queue was full
  bool scripts_stuck = false;                  // one does not come back
};

struct LoggedFile {
  std::string path;
  std::string media_type;
  std::string content;
};

struct LoggedParameter {
  std::string name;
  int slot = 0, size = 1;  // in Log::parameter_values
};

// Inputs, commands and digests of consecutive ticks, bit for bit.
struct LoggedInputs {
  std::vector<std::string> columns;  // named as in engine::InputLayout
  engine::InputNames names;          // of these columns
  std::int64_t first_tick = 0;
  std::vector<std::uint64_t> words;   // ticks x columns
  std::vector<std::uint64_t> digest;  // digest of all signals, by tick
  std::int64_t after_gap = 0;         // ticks of the log that follow a gap, and are not here

  std::int64_t ticks() const { return static_cast<std::int64_t>(digest.size()); }
  const std::uint64_t* row(std::int64_t tick) const {
    return words.data() + static_cast<std::size_t>(tick - first_tick) * columns.size();
  }
};

struct Log {
  std::string path;
  bool complete = false;  // false if truncated or the run was killed
  std::map<std::string, std::string> run;
  std::string setup;             // JSON: the initial condition of a replay
  std::int64_t rate_mhz = 1000;  // ticks per second, in millihertz
  bool part = false;             // a window of the run, see window.h
  int row_every = 1;             // ticks between rows, except around transitions and faults
  std::vector<LoggedSignal> signals;
  std::vector<std::int64_t> tick;          // of each row, increasing
  std::vector<double> time;                // s, of each row
  std::vector<std::vector<float>> column;  // [signal][row], SI
  std::vector<LoggedEvent> events;
  std::vector<LoggedPlan> plans;
  std::vector<LoggedEdit> edits;
  std::vector<std::string> event_names;
  std::vector<LoggedParameter> parameters;
  std::vector<double> parameter_values;  // initial values, by slot
  std::vector<LoggedFile> files;
  LoggedInputs inputs;  // empty unless requested

  // Index of a signal, -1 if absent.
  int find(std::string_view name) const;
  // Column of a signal, nullptr if absent.
  const std::vector<float>* values(std::string_view name) const;
  // Entry of `run`, or `otherwise`.
  std::string get(const std::string& key, const std::string& otherwise = "") const;
  std::size_t rows() const { return time.size(); }
};

// The parts of signal names between `prefix` and `suffix`, each once, in log order:
// parts("contact.", "") gives the feet.
std::vector<std::string> parts(const Log& log, std::string_view prefix, std::string_view suffix);

struct ReadOptions {
  bool all_rows = false;  // false: only every row_every-th tick, evenly spaced
  bool inputs = false;
};

// Throws std::runtime_error with one sentence that names the path if the file is missing, not a
// log, or damaged or truncated before the description of its columns.
Log read_log(const std::string& path, const ReadOptions& options = {});

}  // namespace footfall::lab
