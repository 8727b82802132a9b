// The log of a run, as an MCAP file of protobuf messages that carries its own schema and all that a
// replay needs (docs/log.md): inputs and commands of every tick without loss, derived signals,
// events, planners' answers, edits, and the files that the run was made from. The tick's side
// copies a tick into memory that is there already; a thread codes, compresses and writes. Time is
// that of the ticks, so two equal runs give files that are equal byte for byte.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/signal_table.h"
#include "engine/tick/input_trace.h"
#include "hal/hardware.h"

namespace footfall::engine {

// A file that the run was made from, as it was then.
struct LogFile {
  std::string path;  // absolute
  std::string media_type;
  std::string content;
};

// Where a parameter's values are in Machine::parameters().
struct LogParameter {
  std::string name;
  int slot = 0, size = 1;
};

// What a run was. Keys of `run` that the report reads (metadata record "run", in this order):
//   behavior, robot, world, backend, seed, version: texts
//   states: JSON array of dotted state paths; element i belongs to value i of the signal `state`
//   model: absolute path of the robot's MJCF, for the film strip
struct LogHeader {
  std::vector<std::pair<std::string, std::string>> run;
  std::string setup;                // JSON, metadata record "setup": what a replay starts from
  std::vector<std::string> events;  // names, by event id
  std::vector<LogFile> files;       // attachments
  std::vector<LogParameter> parameters;
  std::vector<double> values;  // of the parameters, by slot
  std::vector<std::string> joints, contacts;
  std::int64_t rate_mhz = 1'000'000;  // ticks per second, in millihertz
  int row_every = 6;     // ticks from one row of derived signals to the next, away from highlights
  bool lockstep = true;  // the tick waits for the log; else a tick that finds no room is dropped,
                         // and an event `gap` says how many were
};

class LogWriter {
 public:
  // Throws std::runtime_error with one sentence that names the path if it cannot be created.
  LogWriter(const std::string& path, const core::SignalTable& table, const LogHeader& header);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // One tick, after its control: signals are table.size() numbers in SI. highlight: derived signals
  // at full rate from 0.2 s before to 0.2 s after. Ticks count up from -1 (what start() read) or 0.
  // Each 50 ms (of ticks; without lock-step of the clock, too) what there is is compressed and
  // written, so that a killed process leaves everything up to 100 ms before.
  void tick(std::int64_t tick, const hal::Sensors& sensors, bool fresh,
            const hal::Commands& commands, const double* signals, bool highlight) noexcept;
  // What came from outside in a tick.
  void inputs(std::int64_t tick, const InputTrace& trace) noexcept;
  // kind: transition, mark, fault, plan, step, ...; texts are cut at 4096 bytes.
  void event(std::int64_t tick, std::string_view kind, std::string_view name,
             std::string_view detail) noexcept;
  // Ends the file. Throws std::runtime_error if any write failed. The destructor calls it, too, and
  // then keeps silent.
  void close();
  // A write failed (disk full, say); close() tells which.
  bool failed() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
