// Finds where two runs diverge, from their logs alone.
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
  std::string text;   // name and both values
};

struct LogComparison {
  std::vector<std::string> setup;          // settings, files, parameters: `NAME: A against B`
  std::vector<LogDifference> differences;  // the first of each kind, by tick
  std::int64_t ticks = 0;                  // number of ticks that both have
  bool same() const { return setup.empty() && differences.empty(); }
};

// Both logs must be read with all_rows and inputs. Signals are compared by name, in rows that both
// have.
LogComparison compare_logs(const Log& a, const Log& b);

}  // namespace footfall::lab
