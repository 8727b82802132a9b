// Why `error.execution` was raised. Plain values: it is noted in the tick and put into words later.
#pragma once

#include <cstdint>

#include "behaviors/compiled/chart.h"

namespace footfall::behaviors {

struct ExecutionProblem {
  enum class Kind : std::uint8_t {
    none,
    value,        // of an expression: not finite, or outside [min, max]
    order,        // a waypoint that does not come after the one before it; its time
    micro_steps,  // more transitions in one tick than allowed
    call,         // a registered function failed
    requests,     // too many calls of scripts in one tick
  };
  Kind kind = Kind::none;
  int index = -1;  // of the expression (-1: unknown), or of the call
  double value = 0.0, min = 0.0, max = 0.0;
};

// Its value is no time (periods_of()).
inline ExecutionProblem no_time(int expression, double seconds) noexcept {
  return {ExecutionProblem::Kind::value, expression, seconds, 0.0, kLongestTime};
}
// Its value is not finite, or outside [min, max] where that is a range.
inline ExecutionProblem bad_value(int expression, double value, double min = 0.0,
                                  double max = 0.0) noexcept {
  return {ExecutionProblem::Kind::value, expression, value, min, max};
}

}  // namespace footfall::behaviors
