// Makes the traces of a suite's runs the golden ones: what would change is shown first.
#pragma once

#include <string>
#include <vector>

#include "lab/scenario/golden_trace.h"
#include "lab/suite/suite.h"

namespace footfall::lab {

// How a trace differs from another, by its signals and states.
struct TraceDiff {
  struct Signal {
    std::string name;
    double largest = 0.0;  // magnitude of the difference, SI
    double time = 0.0;     // s, of it
    bool only_before = false, only_after = false;
  };
  std::vector<Signal> signals;               // that differ, the largest part of its scale first
  std::size_t states = 0;                    // rows in other states
  double first_state = 0.0;                  // s, of the first of them
  double end_before = 0.0, end_after = 0.0;  // s, of the last rows
  bool same() const { return signals.empty() && states == 0 && end_before == end_after; }
};
TraceDiff diff_traces(const GoldenTrace& before, const GoldenTrace& after);

// One trace that would be written.
struct Blessing {
  std::string scenario, from, to;  // from: the run's trace; to: the golden file
  std::string text;                // the difference for people, lines
  std::string refused;             // why it may not become golden; empty: it may
};
// Those of the suite's runs with a golden trace that differ from it, or whose run is not good.
std::vector<Blessing> blessings(const Suite& suite);
// Replaces the golden trace. Throws std::runtime_error.
void bless(const Blessing& blessing);

}  // namespace footfall::lab
