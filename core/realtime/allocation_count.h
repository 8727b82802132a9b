// Counts the heap calls of a thread by replacing libc's malloc and related functions, to show that
// the realtime path makes none. For programs that link footfall::allocation_count.
#pragma once

#include <cstdint>

namespace footfall::core {

// Starts or stops counting this thread's heap calls; calls nest.
void arm_allocation_count(bool on) noexcept;
// Heap calls (frees included) that this thread has made while armed.
std::int64_t allocation_count() noexcept;
// False where a sanitizer owns malloc; nothing is counted then.
bool allocations_are_counted() noexcept;

}  // namespace footfall::core
