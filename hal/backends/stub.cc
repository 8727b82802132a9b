// Joints on a stand, their actuators, scripted contacts; see stub.h.
#include "hal/backends/stub.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace footfall::hal {

namespace {

SensorPlaces places_of(const StubSettings& settings) {
  SensorPlaces places = settings.places;
  places.joints = settings.joints;
  places.contacts = settings.contacts;
  return places;
}

}  // namespace

StubBackend::StubBackend(StubSettings settings) : settings_(std::move(settings)) {
  if (settings_.joints < 0 || settings_.joints > core::kMaxJoints || settings_.contacts < 0 ||
      settings_.contacts > core::kMaxContacts) {
    throw std::runtime_error("stub backend: too many joints or contacts");
  }
  if (!(settings_.period > 0.0) || !(settings_.inertia > 0.0)) {
    throw std::runtime_error("stub backend: period and inertia must be positive");
  }
  if (settings_.drive_steps < 1 || settings_.command_delay < 0 || settings_.stiffness < 0.0 ||
      settings_.damping < 0.0) {
    throw std::runtime_error("stub backend: steps, delay, stiffness or damping are negative");
  }
  sensors_.emplace(settings_.sensors, places_of(settings_), settings_.period, settings_.noise_seed);
  settings_.start.resize(static_cast<std::size_t>(settings_.joints), 0.0);
  if (settings_.drive) drive_.emplace(*settings_.drive);
  if (settings_.stiffness > 0.0) {
    // A joint's inertia on a spring to the ground moves as a rotor on a spring to a locked output.
    const double step = settings_.period / (drive_ ? settings_.drive_steps : 1);
    stand_.assign(settings_.start.size(), SeriesElasticActuator({.spring = settings_.stiffness,
                                                                 .rotor = settings_.inertia,
                                                                 .viscous = settings_.damping},
                                                                step));
  }
}

// A law that relies on no contact at all (flight, or a robot that is let down) changes nothing.
void StubBackend::set_support(std::uint64_t contacts) noexcept {
  for (int c = 0; c < settings_.contacts && contacts != 0; ++c) {
    std::int64_t& released = released_[static_cast<std::size_t>(c)];
    if ((contacts >> static_cast<unsigned>(c) & 1U) != 0) {
      released = -1;
    } else if (released < 0) {
      released = tick_;
    }
  }
}

bool StubBackend::is_closed(int contact, double time) const noexcept {
  if (settings_.contact_script) return settings_.contact_script(contact, time);
  const std::int64_t released = released_[static_cast<std::size_t>(contact)];
  if (released < 0 || settings_.swing <= 0.0) return true;
  return static_cast<double>(tick_ - released) * settings_.period >= settings_.swing;
}

void StubBackend::start() {
  q_ = settings_.start;
  qd_.assign(q_.size(), 0.0);
  tau_.assign(q_.size(), 0.0);
  for (SeriesElasticActuator& joint : stand_) joint.set_state({});
  if (drive_) drive_->start(q_, tau_);
  delayed_.assign(static_cast<std::size_t>(settings_.command_delay) + 1, tau_);
  released_.fill(-1);
  sensors_->start({.p_WB = settings_.base});
  tick_ = 0;
  stopped_ = false;
}

bool StubBackend::read(Sensors& sensors) noexcept {
  const double time = static_cast<double>(tick_) * settings_.period;
  sensors.time_ns = std::llround(time * 1e9);
  std::copy(q_.begin(), q_.end(), sensors.q.begin());
  std::copy(qd_.begin(), qd_.end(), sensors.qd.begin());
  std::copy(tau_.begin(), tau_.end(), sensors.tau.begin());
  std::copy(q_.begin(), q_.end(), truth_.q.begin());
  std::copy(qd_.begin(), qd_.end(), truth_.qd.begin());
  if (drive_) drive_->read(sensors);
  for (int c = 0; c < settings_.contacts; ++c) {
    truth_.normal_force[static_cast<std::size_t>(c)] =
        is_closed(c, time) ? std::numeric_limits<double>::infinity() : 0.0;
  }
  sensors.has_truth = true;
  sensors.p_WB = settings_.base;
  sensors.q_WB = {1.0, 0.0, 0.0, 0.0};
  sensors.v_WB = {};
  sensors.w_WB_B = {};
  sensors_->sample(truth_, sensors);
  return true;
}

void StubBackend::write(const Commands& commands) noexcept {
  for (std::size_t j = 0; j < tau_.size(); ++j) tau_[j] = stopped_ ? 0.0 : commands.tau[j];
  if (drive_) {
    drive_->command(tau_);
    const double step = settings_.period / settings_.drive_steps;
    for (int k = 0; k < settings_.drive_steps; ++k) {
      drive_->place(q_);
      drive_->advance(qd_, tau_);
      move(tau_, step);
    }
  } else {
    std::ranges::copy(tau_, delayed_[static_cast<std::size_t>(tick_) % delayed_.size()].begin());
    tau_ = delayed_[static_cast<std::size_t>(tick_ + 1) % delayed_.size()];
    move(tau_, settings_.period);
  }
  ++tick_;
}

// Exact for torques that are constant over the time.
void StubBackend::move(std::span<const double> torques, double time) noexcept {
  for (std::size_t j = 0; j < q_.size(); ++j) {
    if (!stand_.empty()) {
      stand_[j].advance(torques[j], 0.0);
      q_[j] = settings_.start[j] + stand_[j].state().deflection;
      qd_[j] = stand_[j].state().rate;
      continue;
    }
    const double acceleration = torques[j] / settings_.inertia;
    q_[j] += (qd_[j] + 0.5 * acceleration * time) * time;
    qd_[j] += acceleration * time;
  }
}

void StubBackend::set_torque_loop(int joint, const TorqueLoopGains& gains) noexcept {
  if (drive_) drive_->change_gains(joint, gains);
}

void StubBackend::safe_stop() noexcept { stopped_ = true; }

}  // namespace footfall::hal
