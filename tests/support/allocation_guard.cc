// Interposed malloc and friends; see allocation_guard.h.
#include "tests/support/allocation_guard.h"

#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FOOTFALL_COUNT_ALLOCATIONS 0
#else
#define FOOTFALL_COUNT_ALLOCATIONS 1
#endif

namespace {
thread_local int armed = 0;
thread_local long heap_calls = 0;
#if FOOTFALL_COUNT_ALLOCATIONS
void count() noexcept {
  if (armed > 0) ++heap_calls;
}
#endif
}  // namespace

#if FOOTFALL_COUNT_ALLOCATIONS
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t items, std::size_t size) {
  count();
  return __libc_calloc(items, size);
}
void* realloc(void* old, std::size_t size) {
  count();
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  count();
  *result = __libc_memalign(alignment, size);
  return *result ? 0 : ENOMEM;
}
void free(void* memory) {
  if (memory) count();
  __libc_free(memory);
}
}
#endif

namespace footfall::tests {

AllocationGuard::AllocationGuard() noexcept {
  heap_calls = 0;
  ++armed;
}
AllocationGuard::~AllocationGuard() { --armed; }
bool AllocationGuard::counts() noexcept { return FOOTFALL_COUNT_ALLOCATIONS != 0; }
long AllocationGuard::allocations() const noexcept { return heap_calls; }

}  // namespace footfall::tests
