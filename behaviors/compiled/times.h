// Times of a behavior that its parameters make negative, zero where they must not be, or undefined.
// Load time only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"

namespace footfall::behaviors {

struct BadTime {
  const TimeUse* use = nullptr;
  std::optional<double> value;  // s; nullopt: not finite
};

// The times that are out of limits with the behavior's values. Excluded: times that depend on
// measurements or on parameters set by actions, and those of transitions whose condition the
// parameters make false.
std::vector<BadTime> bad_times(const Behavior& behavior);
// `is -400 ms: expected a time from 0 s to 10^6 s`.
std::string bad_time_text(const BadTime& time);

}  // namespace footfall::behaviors
