// Counts heap allocations of the calling thread while armed, by interposing malloc in this program.
#pragma once

#include <cstdint>

namespace footfall::apps {

void arm_allocations(bool on);
std::int64_t allocations();      // counted so far in this thread
bool allocations_are_counted();  // false in sanitizer builds, which own malloc

}  // namespace footfall::apps
