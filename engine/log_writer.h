// The log of a run: every signal at a chosen rate and every event, as an MCAP file of protobuf
// messages that carries its own schema, names, units and the run's settings. Time is simulated
// time, so two equal runs give files that are equal byte for byte. Called by the logger, after the
// tick.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/signal_table.h"

namespace footfall::engine {

// What a run was: key and value pairs for the metadata record "run" (behavior, robot, world, seed,
// version, states, model, contacts, ...), in this order. Keys that the report reads:
//   behavior, robot, world, backend, seed, version: texts
//   states: JSON array of dotted state paths; element i belongs to value i of the signal `state`
//   model: absolute path of the robot's MJCF, for the film strip
struct LogHeader {
  std::vector<std::pair<std::string, std::string>> run;
};

// Channels:
//   /signals  footfall.Signals  one field a signal (float; double for times), named as the signal
//                               with `_` for `.`; field number = index of the signal + 1
//   /events   footfall.Event    {double time, string kind, string name, string detail}
// Metadata records: "run" (LogHeader) and "signals" (key "signals": JSON array of {name, field,
// unit, doc} in the order of the table).
class LogWriter {
 public:
  // Throws std::runtime_error with one sentence that names the path if it cannot be created.
  LogWriter(const std::string& path, const core::SignalTable& table, const LogHeader& header);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Writes one row. values: table.size() numbers in SI, e.g. SignalTable::values(). About 0.1 us
  // for 200 signals, and no allocation; each 0.5 s or 256 kB a chunk is compressed and written.
  void sample(std::int64_t time_ns, const double* values) noexcept;
  // Writes one event. kind: transition, mark, fault, plan, step, ...; texts are cut at 4096 bytes.
  void event(std::int64_t time_ns, std::string_view kind, std::string_view name,
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
