// Explains a tick of a behavior: transitions taken and not taken, each guard's terms with their
// values, timers, events. From a replay.
#pragma once

#include <cstdint>
#include <string>

#include "lab/replay/replay.h"

namespace footfall::lab {

// The default tick to explain: that of the last fall, else of the last transition, else the last
// one.
std::int64_t telling_tick(const Log& log);

// Runs a replay that has not begun up to `tick` and returns a textual explanation of that tick.
// Throws std::runtime_error if the log is shorter.
std::string explain_tick(Replay& replay, std::int64_t tick);

// The faults of the second up to a tick, and the reason if the run ended there; lines, maybe none.
std::string faults_until(const Log& log, std::int64_t tick);

}  // namespace footfall::lab
