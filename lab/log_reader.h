// Reads the log of a run (engine/log_writer.h), whole or cut off at any byte: what was complete
// before the cut is there. After a run, for reports, comparisons and tests.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace footfall::lab {

struct LoggedSignal {
  std::string name;   // dotted, e.g. com.pos.z
  std::string field;  // of the protobuf message
  std::string unit;   // SI; empty for a plain number
  std::string doc;
};

struct LoggedEvent {
  double time = 0.0;  // s
  std::string kind;   // transition, mark, fault, plan, step, ...
  std::string name;
  std::string detail;
};

struct Log {
  std::string path;
  bool complete = false;  // false: no proper end, the run was killed or the file cut
  std::map<std::string, std::string> run;
  std::vector<LoggedSignal> signals;
  std::vector<double> time;                // s, of each row
  std::vector<std::vector<float>> column;  // [signal][row], SI
  std::vector<LoggedEvent> events;

  // Index of a signal, -1 if there is none.
  int find(std::string_view name) const;
  // Column of a signal, null if there is none.
  const std::vector<float>* values(std::string_view name) const;
  // Entry of `run`, or `otherwise`.
  std::string get(const std::string& key, const std::string& otherwise = "") const;
  std::size_t rows() const { return time.size(); }
};

// Throws std::runtime_error with one sentence that names the path: missing, not a log, or damaged
// or cut before its first row could be described.
Log read_log(const std::string& path);

}  // namespace footfall::lab
