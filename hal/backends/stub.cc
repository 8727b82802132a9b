// Double-integrator joints and scripted contacts; see stub.h.
#include "hal/backends/stub.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace footfall::hal {

StubBackend::StubBackend(StubSettings settings) : settings_(std::move(settings)) {
  if (settings_.joints < 0 || settings_.joints > core::kMaxJoints || settings_.contacts < 0 ||
      settings_.contacts > core::kMaxContacts) {
    throw std::runtime_error("stub backend: too many joints or contacts");
  }
  if (!(settings_.period > 0.0) || !(settings_.inertia > 0.0)) {
    throw std::runtime_error("stub backend: period and inertia must be positive");
  }
  settings_.start.resize(static_cast<std::size_t>(settings_.joints), 0.0);
}

void StubBackend::start() {
  q_ = settings_.start;
  qd_.assign(q_.size(), 0.0);
  tau_.assign(q_.size(), 0.0);
  tick_ = 0;
  stopped_ = false;
}

bool StubBackend::read(Sensors& sensors) noexcept {
  const double time = static_cast<double>(tick_) * settings_.period;
  sensors.time_ns = std::llround(time * 1e9);
  std::copy(q_.begin(), q_.end(), sensors.q.begin());
  std::copy(qd_.begin(), qd_.end(), sensors.qd.begin());
  std::copy(tau_.begin(), tau_.end(), sensors.tau.begin());
  for (int c = 0; c < settings_.contacts; ++c) {
    sensors.contact[static_cast<std::size_t>(c)] =
        !settings_.contact_script || settings_.contact_script(c, time);
  }
  sensors.has_truth = true;
  sensors.p_WB = settings_.base;
  sensors.q_WB = {1.0, 0.0, 0.0, 0.0};
  sensors.v_WB = {};
  sensors.w_WB_B = {};
  return true;
}

void StubBackend::write(const Commands& commands) noexcept {
  // Exact for a torque that is constant over the period.
  for (std::size_t j = 0; j < q_.size(); ++j) {
    tau_[j] = stopped_ ? 0.0 : commands.tau[j];
    const double acceleration = tau_[j] / settings_.inertia;
    q_[j] += (qd_[j] + 0.5 * acceleration * settings_.period) * settings_.period;
    qd_[j] += acceleration * settings_.period;
  }
  ++tick_;
}

void StubBackend::safe_stop() noexcept { stopped_ = true; }

}  // namespace footfall::hal
