// malloc interposition; see allocations.h. The counters are plain thread-local integers, so that
// the interposed functions allocate nothing themselves.
#include "apps/allocations.h"

#include <cerrno>
#include <cstddef>

namespace {
thread_local bool t_armed = false;
thread_local std::int64_t t_count = 0;
#ifndef FOOTFALL_SANITIZED
void count() {
  if (t_armed) ++t_count;
}
#endif
}  // namespace

namespace footfall::apps {
void arm_allocations(bool on) { t_armed = on; }
std::int64_t allocations() { return t_count; }
#ifdef FOOTFALL_SANITIZED
bool allocations_are_counted() { return false; }
#else
bool allocations_are_counted() { return true; }
#endif
}  // namespace footfall::apps

#ifndef FOOTFALL_SANITIZED
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  count();
  return __libc_calloc(n, size);
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
}
#endif
