// Priority of threads beside the tick.
#pragma once

namespace footfall::core {

// The calling thread, and programs that it starts, run from now on only where no other thread of
// the machine wants the processor: SCHED_IDLE, which needs no rights, or nice 19 if that is
// refused. A realtime class inherited from the creating thread ends. Without rights there is no way
// back.
void take_idle_priority() noexcept;

}  // namespace footfall::core
