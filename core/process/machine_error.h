// What the machine refused, not the user's input: exit code 3.
#pragma once

#include <stdexcept>

namespace footfall::core {

// No space, no permission, a program or a device that is missing. The text names the file or thing.
struct MachineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace footfall::core
