// The signals that end a command which has something to bring to a safe end: SIGINT (Ctrl-C),
// SIGTERM, and SIGHUP (the terminal went away) unless it was ignored when the command began, as
// `nohup` does.
#pragma once

#include <atomic>

namespace footfall::core {

// From now on the first of these signals sets the flag in the place of ending the process. After a
// second one the process has one second more, whatever hangs; then it exits with 128 + its number.
// Never nullptr.
const std::atomic<bool>* stop_on_signals() noexcept;

// Whether one came; never true before stop_on_signals().
bool stop_flag() noexcept;

}  // namespace footfall::core
