// Scheduling classes of Linux; see thread_priority.h.
#include "core/realtime/thread_priority.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

namespace footfall::core {

void take_idle_priority() noexcept {
  const sched_param none{};
  // For both calls 0 is the calling thread, not its process.
  if (::sched_setscheduler(0, SCHED_IDLE, &none) == 0) return;
  ::sched_setscheduler(0, SCHED_OTHER, &none);
  ::setpriority(PRIO_PROCESS, 0, 19);
}

}  // namespace footfall::core
