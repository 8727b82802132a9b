// Where two runs part, from their logs alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lab/log/reader.h"

namespace footfall::lab {

// The first difference of one kind.
struct LogDifference {
  std::string kind;  // input, command, signal, event, edit, plan, length
  std::int64_t tick = 0;
  double time = 0.0;  // s
  std::string text;   // what: both values
};

struct LogComparison {
  std::vector<std::string> setup;          // settings, files, parameters: `NAME: A against B`
  std::vector<LogDifference> differences;  // first of each kind, in the order of their ticks
  std::int64_t ticks = 0;                  // that both have
  bool same() const { return setup.empty() && differences.empty(); }
};

// Both read with all_rows and inputs. Signals are compared by name, in rows that both have.
LogComparison compare_logs(const Log& a, const Log& b);

}  // namespace footfall::lab
