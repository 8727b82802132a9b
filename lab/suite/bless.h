// Makes the traces of a suite's runs the new golden traces, after showing the changes.
#pragma once

#include <string>
#include <vector>

#include "lab/scenario/golden_trace.h"
#include "lab/suite/suite.h"

namespace footfall::lab {

// Difference between two traces, by signals and states.
struct TraceDiff {
  struct Signal {
    std::string name;
    double largest = 0.0;  // magnitude of the difference, SI
    double time = 0.0;     // s, time of the largest difference
    bool only_before = false, only_after = false;
  };
  std::vector<Signal> signals;               // differing signals, largest relative difference first
  std::size_t states = 0;                    // number of rows in different states
  double first_state = 0.0;                  // s, time of the first such row
  double end_before = 0.0, end_after = 0.0;  // s, end times
  bool same() const { return signals.empty() && states == 0 && end_before == end_after; }
};
TraceDiff diff_traces(const GoldenTrace& before, const GoldenTrace& after);

// One golden trace to be replaced.
struct Blessing {
  std::string scenario, from, to;  // from: the run's trace; to: the golden file
  std::string text;                // description of the difference, several lines
  std::string refused;             // why it must not become golden; empty if it may
};
// Traces that differ from their golden trace, and those of unsuccessful runs.
std::vector<Blessing> blessings(const Suite& suite);
// Copies to a temporary file and renames it. Throws std::runtime_error.
void bless(const Blessing& blessing);

}  // namespace footfall::lab
