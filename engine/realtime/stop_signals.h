// The process' signals that end a run: SIGINT (Ctrl-C) and SIGTERM set a flag, which the executive
// looks at before each tick.
#pragma once

#include <atomic>

namespace footfall::engine {

// From now on the two signals set the flag in the place of ending the process. Never nullptr.
const std::atomic<bool>* stop_on_signals() noexcept;

}  // namespace footfall::engine
