// Why a behavior did what it did at a tick: which transitions were taken and which were not, each
// guard's terms with their values, timers, events. From a replay.
#pragma once

#include <cstdint>
#include <string>

#include "lab/replay/replay.h"

namespace footfall::lab {

// The tick to explain if none was named: that of the last fall, else of the last transition, else
// the last one.
std::int64_t telling_tick(const Log& log);

// Runs the replay, which has not begun, to `tick` and tells what it did there, as text for people.
// Throws std::runtime_error if the log does not reach that far.
std::string explain_tick(Replay& replay, std::int64_t tick);

}  // namespace footfall::lab
