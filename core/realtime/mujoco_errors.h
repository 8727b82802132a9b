// Turns MuJoCo's errors and warnings into ours: installed once per process, before any model loads.
#pragma once

#include <cstdint>

namespace footfall::core {

// Before a run starts, a MuJoCo error throws std::runtime_error with MuJoCo's own text. Warnings
// are counted and never written to MUJOCO_LOG.TXT. Safe to call again.
void install_mujoco_error_handlers();

// While a run is under way an error must not unwind through the tick: it is recorded, `on_error`
// (may be null; must not allocate or throw) is called, and the process ends with exit code 3.
void set_mujoco_running(bool running, void (*on_error)()) noexcept;

// Warnings MuJoCo raised through its handler since the process began.
std::int64_t mujoco_warning_count() noexcept;
// The last warning's text ("" if none); points to static storage.
const char* mujoco_last_warning() noexcept;

}  // namespace footfall::core
