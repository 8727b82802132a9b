// A golden trace: some signals of a run at a low rate, as a CSV file that can be read and compared
// line by line: `time,state,SIGNAL,...`, SI, an empty field where a signal has no value.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/tick/control_loop.h"
#include "lab/scenario/description.h"

namespace footfall::lab {

struct GoldenRow {
  double time = 0.0;  // s
  std::string state;  // paths of the active atomic states
  std::vector<double> values;
};

struct GoldenTrace {
  std::vector<std::string> signals;  // names
  std::vector<GoldenRow> rows;
};

// Throws std::runtime_error `PATH:LINE: error: ...` if the file is malformed.
GoldenTrace read_golden(const std::string& path);
// Writes as many digits as needed for a hundredth of each tolerance. Atomic; throws
// std::runtime_error if the file cannot be written.
void write_golden(const std::string& path, const GoldenSpec& spec, const GoldenTrace& trace);

// The first value beyond its tolerance: signal, time, state, actual and expected value.
struct GoldenMismatch {
  std::string text;          // empty: the traces agree
  std::optional<double> at;  // s
};
// Signals that only one of the two has and a different length are mismatches, too.
GoldenMismatch compare_golden(const GoldenSpec& spec, const core::SignalTable& signals,
                              const GoldenTrace& expected, const GoldenTrace& got);

// Records the trace of a run, after each tick's compute().
class GoldenRecorder {
 public:
  GoldenRecorder(const GoldenSpec& spec, const engine::ControlLoop& loop);
  void observe();
  const GoldenTrace& trace() const { return trace_; }

 private:
  const GoldenSpec& spec_;
  const engine::ControlLoop& loop_;
  std::int64_t every_;  // ticks per row
  GoldenTrace trace_;
};

}  // namespace footfall::lab
