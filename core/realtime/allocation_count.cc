// malloc interposition; see allocation_count.h. The counters are plain thread-local integers, so
// that the interposed functions allocate nothing.
#include "core/realtime/allocation_count.h"

#include <cerrno>
#include <cstddef>

namespace {
thread_local int t_armed = 0;
thread_local std::int64_t t_count = 0;
}  // namespace

namespace footfall::core {
void arm_allocation_count(bool on) noexcept { t_armed += on ? 1 : -1; }
std::int64_t allocation_count() noexcept { return t_count; }
#ifdef FOOTFALL_SANITIZER_OWNS_MALLOC
bool allocations_are_counted() noexcept { return false; }
#else
bool allocations_are_counted() noexcept { return true; }
#endif
}  // namespace footfall::core

#ifndef FOOTFALL_SANITIZER_OWNS_MALLOC
namespace {
void count() noexcept {
  if (t_armed > 0) ++t_count;
}
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);

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
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  count();
  *out = __libc_memalign(alignment, size);
  return *out ? 0 : ENOMEM;
}
void free(void* memory) {
  if (memory) count();
  __libc_free(memory);
}
}
#endif
