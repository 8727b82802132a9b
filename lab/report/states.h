// The state diagram of a run's behavior with the time that was spent in each state, for the report.
#pragma once

#include <string>

#include "behaviors/explain/diagram.h"
#include "lab/log/reader.h"

namespace footfall::lab {

// By a path and all below it, from the signal `state`: the first active atomic state, so that of
// parallel regions only the first is seen.
struct StateUse {
  double time = 0.0;  // s
  int visits = 0;
};
StateUse state_use(const Log& log, const std::string& path);

// Writes share and visits into the states of a diagram that the log has seen, or could have: their
// name line is followed by `12.3 s, 20.5 %, 173 visits`, or `never`.
void add_state_use(const Log& log, behaviors::Diagram& diagram);

// As a Graphviz graph, from the files in the log. Throws std::runtime_error if they do not load.
std::string state_graph(const Log& log);

}  // namespace footfall::lab
