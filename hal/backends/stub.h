// A backend without physics: every joint is a double integrator q̈ = τ / inertia, the base does not
// move, contacts follow a script. It runs the same tick as a simulator or a robot, for tests of the
// engine and of a behavior's timing.
#pragma once

#include <functional>
#include <vector>

#include "hal/hardware.h"

namespace footfall::hal {

struct StubSettings {
  int joints = 0;
  int contacts = 0;
  double period = 0.0;           // s
  double inertia = 1.0;          // kg m^2, of every joint
  std::vector<double> start;     // rad, joint positions at start
  std::array<double, 3> base{};  // m, base origin in the world
  // Whether a contact is closed at a time (s); null: all closed, always.
  std::function<bool(int contact, double time)> contact_script;
};

class StubBackend final : public Hardware {
 public:
  // Throws std::runtime_error if the sizes are inconsistent.
  explicit StubBackend(StubSettings settings);
  std::string name() const override { return "stub"; }
  void start() override;
  bool read(Sensors& sensors) noexcept override;
  void write(const Commands& commands) noexcept override;
  void safe_stop() noexcept override;

 private:
  StubSettings settings_;
  std::vector<double> q_, qd_, tau_;
  std::int64_t tick_ = 0;
  bool stopped_ = false;
};

}  // namespace footfall::hal
