// A backend whose sensors can be made to fail on purpose: scenarios ask for it. What fails keeps
// its last value and says so.
#pragma once

#include <string>

#include "hal/hardware.h"

namespace footfall::hal {

enum class SensorGroup : std::uint8_t {
  mocap,  // Sensors::mocap_fresh
  imu,    // gyro, accelerometer, Sensors::imu_fresh
  all,    // everything: read() tells that nothing new has come
};

class SensorFaults final : public Hardware {
 public:
  // `real` must outlive it.
  explicit SensorFaults(Hardware& real) : real_(real) {}

  // Between two ticks.
  void fail(SensorGroup group, bool on) noexcept { failing_[static_cast<std::size_t>(group)] = on; }

  std::string name() const override { return real_.name(); }
  void start() override;
  bool read(Sensors& sensors) noexcept override;
  void write(const Commands& commands) noexcept override { real_.write(commands); }
  void safe_stop() noexcept override { real_.safe_stop(); }
  bool uses_torque_loop() const override { return real_.uses_torque_loop(); }

 private:
  bool failing(SensorGroup group) const noexcept {
    return failing_[static_cast<std::size_t>(group)];
  }
  Hardware& real_;
  Sensors fresh_;
  std::array<bool, 3> failing_{};
};

}  // namespace footfall::hal
