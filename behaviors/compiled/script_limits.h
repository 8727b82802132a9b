// What one call of a script may take.
#pragma once

#include <cstdint>

namespace footfall::behaviors {

struct ScriptLimits {
  std::int64_t instructions = 10'000'000;  // of Lua's virtual machine: decides alike everywhere
  double deadline = 0.0;                   // s of processor time; 0: follows from the instructions
};

}  // namespace footfall::behaviors
