// Counts heap calls of the calling thread while a guard lives. The interposed functions must be in
// the test's own executable (allocation_guard.cc among its sources). Under a sanitizer nothing is
// counted: `counts()` says so.
#pragma once

namespace footfall::tests {

class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  static bool counts() noexcept;      // false under sanitizers
  long allocations() const noexcept;  // since construction, frees included
};

}  // namespace footfall::tests
