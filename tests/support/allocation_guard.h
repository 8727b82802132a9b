// Counts heap calls of the calling thread while a guard lives. The test links
// footfall::allocation_count. Under a sanitizer nothing is counted: `counts()` says so.
#pragma once

#include "core/realtime/allocation_count.h"

namespace footfall::tests {

class AllocationGuard {
 public:
  AllocationGuard() noexcept : before_(core::allocation_count()) {
    core::arm_allocation_count(true);
  }
  ~AllocationGuard() { core::arm_allocation_count(false); }
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  static bool counts() noexcept { return core::allocations_are_counted(); }
  // Since construction, frees included.
  long allocations() const noexcept { return core::allocation_count() - before_; }

 private:
  std::int64_t before_;
};

}  // namespace footfall::tests
