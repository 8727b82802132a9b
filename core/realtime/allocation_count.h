// Counts heap calls of a thread, by malloc and friends of its own in place of libc's. For programs
// that link footfall::allocation_count (objects, no library): the realtime path is shown to make
// none.
#pragma once

#include <cstdint>

namespace footfall::core {

// From now on this thread's heap calls count, or no longer; once for each time it was switched on.
void arm_allocation_count(bool on) noexcept;
// Heap calls (frees included) that this thread has made while armed.
std::int64_t allocation_count() noexcept;
// False where a sanitizer owns malloc: then nothing is counted.
bool allocations_are_counted() noexcept;

}  // namespace footfall::core
