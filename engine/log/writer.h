// The log of a run, as an MCAP file of protobuf messages that contains its own schema and
// everything needed for a replay (docs/log.md): lossless inputs and commands of every tick, derived
// signals, events, planners' answers, edits, and the run's input files. The tick copies its data to
// preallocated memory; a thread encodes, compresses and writes. Times are tick times, so equal runs
// give byte-identical files.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/signal_table.h"
#include "engine/tick/input_row.h"
#include "engine/tick/input_trace.h"
#include "hal/hardware.h"

namespace footfall::engine {

// An input file of the run, with its content at that time.
struct LogFile {
  std::string path;  // absolute
  std::string media_type;
  std::string content;
};

// Location of a parameter's values in Machine::parameters().
struct LogParameter {
  std::string name;
  int slot = 0, size = 1;
};

// Description of a run. Keys of `run` that the report reads (metadata record "run", in this order):
//   behavior, robot, world, backend, seed, version: texts
//   states: JSON array of dotted state paths; element i belongs to value i of the signal `state`
//   model: absolute path of the robot's MJCF, for the film strip
struct LogHeader {
  std::vector<std::pair<std::string, std::string>> run;
  std::string setup;                // JSON, metadata record "setup": start of a replay
  std::vector<std::string> events;  // names, by event id
  std::vector<LogFile> files;       // attachments
  std::vector<LogParameter> parameters;
  std::vector<double> values;         // initial parameter values, by slot
  InputNames names;                   // of the inputs' columns
  std::int64_t rate_mhz = 1'000'000;  // ticks per second, in millihertz
  int row_every = 6;     // ticks between rows of derived signals, except around highlights
  bool lockstep = true;  // the tick waits for the log; else it is dropped, event `gap` counts
};

class LogWriter {
 public:
  // Throws std::runtime_error with one sentence that names the path if the file cannot be created.
  LogWriter(const std::string& path, const core::SignalTable& table, const LogHeader& header);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Logs one tick, after its control: signals are table.size() numbers in SI. highlight: derived
  // signals at full rate from 0.2 s before to 0.2 s after. Ticks are counted from -1 (data read by
  // start()) or 0. Every 50 ms (of tick time; without lock-step also of clock time) the available
  // data are compressed and written, so that a killed process leaves all data up to 100 ms before.
  void tick(std::int64_t tick, const hal::Sensors& sensors, bool fresh,
            const hal::Commands& commands, const double* signals, bool highlight) noexcept;
  // Logs the external inputs of a tick.
  void inputs(std::int64_t tick, const InputTrace& trace) noexcept;
  // kind: transition, mark, fault, plan, step, ...; texts are truncated to 4096 bytes.
  void event(std::int64_t tick, std::string_view kind, std::string_view name,
             std::string_view detail) noexcept;
  // Completes the file. Throws std::runtime_error if any write failed. Also called by the
  // destructor, which ignores errors.
  void close();
  // Ticks that are not in the log, because writing them was too slow (never in lock-step).
  std::int64_t lost() const noexcept;
  // Whether a write failed (e.g. disk full); close() reports the error.
  bool failed() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
