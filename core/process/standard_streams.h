// The three standard streams of a command: always open, never a reason to stop in the middle.
#pragma once

#include <string>

namespace footfall::core {

// First thing in main(). Closed descriptors 0 to 2 are opened on the null device, so that no file
// of the command gets their number and what is printed. SIGPIPE and SIGXFSZ are ignored. From here
// on writing to stdout and stderr never fails: what could not be written to stdout is remembered
// and told by finish_standard_output(); what could not be written to stderr is lost.
void open_standard_streams();

// Whether something could not be written to stdout. Commands that print until they are stopped look
// at it.
bool standard_output_failed() noexcept;

// Last thing in main(): writes what stdout still holds. Returns why something was not written
// ("No space left on device"); empty if all was, or if the reader of a pipe has gone, which ends
// the talking and is no error.
std::string finish_standard_output();

}  // namespace footfall::core
