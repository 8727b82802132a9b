// Handlers for MuJoCo's errors and warnings, installed once per process before any model is loaded.
#pragma once

#include <cstdint>

namespace footfall::core {

// Makes a MuJoCo error throw std::runtime_error with MuJoCo's text, as long as no run is active.
// Warnings are counted and never written to MUJOCO_LOG.TXT. Idempotent.
void install_mujoco_error_handlers();

// Marks a run as active. An error then must not unwind through the tick: it is recorded, `on_error`
// (may be null; must not allocate or throw) is called, and the process ends with exit code 3.
void set_mujoco_running(bool running, void (*on_error)()) noexcept;

// Number of warnings from MuJoCo's handler since the process began.
std::int64_t mujoco_warning_count() noexcept;
// Text of the last warning, "" if none; static storage.
const char* mujoco_last_warning() noexcept;

}  // namespace footfall::core
