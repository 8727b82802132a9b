// The state diagram of a run's behavior with the time spent in each state, for the report.
#pragma once

#include <string>

#include "behaviors/explain/diagram.h"
#include "lab/log/reader.h"

namespace footfall::lab {

// Time and visits of a state and its descendants. From the signal `state`, which is the first
// active atomic state: of parallel regions only the first one is seen.
struct StateUse {
  double time = 0.0;  // s
  int visits = 0;
};
StateUse state_use(const Log& log, const std::string& path);

// Adds share and visits to all states of a diagram that the log can contain: the name is followed
// by `12.3 s, 20.5 %, 173 visits`, or `never`.
void add_state_use(const Log& log, behaviors::Diagram& diagram);

// The diagram in Graphviz format, from the files in the log. Throws std::runtime_error if they do
// not load.
std::string state_graph(const Log& log);

}  // namespace footfall::lab
