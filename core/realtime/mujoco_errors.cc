// MuJoCo's process-global handlers; see mujoco_errors.h.
#include "core/realtime/mujoco_errors.h"

#include <mujoco/mujoco.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace footfall::core {
namespace {

constexpr int kMujocoFailed = 3;  // exit code: the machine or the backend failed

std::atomic<bool> g_running{false};
std::atomic<void (*)()> g_on_error{nullptr};
std::atomic<std::int64_t> g_warnings{0};
std::array<char, 512> g_last_warning{};

void on_error(const char* message) {
  if (!g_running.load()) throw std::runtime_error(std::string("MuJoCo: ") + message);
  std::fprintf(stderr, "footfall: error: MuJoCo failed during the run: %s\n", message);
  if (auto* stop = g_on_error.load()) stop();
  std::_Exit(kMujocoFailed);
}

void on_warning(const char* message) {
  g_warnings.fetch_add(1);
  std::strncpy(g_last_warning.data(), message, g_last_warning.size() - 1);
}

}  // namespace

void install_mujoco_error_handlers() {
  mju_user_error = on_error;
  mju_user_warning = on_warning;
}

void set_mujoco_running(bool running, void (*stop)()) noexcept {
  g_on_error.store(stop);
  g_running.store(running);
}

std::int64_t mujoco_warning_count() noexcept { return g_warnings.load(); }
const char* mujoco_last_warning() noexcept { return g_last_warning.data(); }

}  // namespace footfall::core
