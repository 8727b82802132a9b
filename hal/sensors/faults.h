// A backend whose sensors can be made to fail on purpose: scenarios ask for it. A field that fails
// keeps its last value, its group's validity flag is false; one that is frozen keeps its last value
// and is said to be valid.
#pragma once

#include <string>

#include "hal/hardware.h"

namespace footfall::hal {

class SensorFaults final : public Hardware {
 public:
  // `real` must outlive it.
  explicit SensorFaults(Hardware& real) : real_(real) {}

  // Between two ticks.
  void fail(SensorGroup group, bool on) noexcept { failing_[static_cast<std::size_t>(group)] = on; }

  // A group that freezes; not `all`.
  void freeze(SensorGroup group, bool on) noexcept {
    frozen_[static_cast<std::size_t>(group)] = on;
  }
  // Motion capture that sees kFewMarkers of the markers at most.
  void hide_markers(bool on) noexcept { hidden_ = on; }
  static constexpr std::size_t kFewMarkers = 2;

  std::string name() const override { return real_.name(); }
  void start() override;
  bool read(Sensors& sensors) noexcept override;
  void write(const Commands& commands) noexcept override { real_.write(commands); }
  void safe_stop() noexcept override { real_.safe_stop(); }
  bool uses_torque_loop() const override { return real_.uses_torque_loop(); }
  void set_support(std::uint64_t contacts) noexcept override { real_.set_support(contacts); }
  void set_torque_loop(int joint, const TorqueLoopGains& gains) noexcept override {
    real_.set_torque_loop(joint, gains);
  }

 private:
  bool failing(SensorGroup group) const noexcept {
    return failing_[static_cast<std::size_t>(group)];
  }
  bool frozen(SensorGroup group) const noexcept { return frozen_[static_cast<std::size_t>(group)]; }
  Hardware& real_;
  Sensors fresh_;
  std::array<bool, static_cast<std::size_t>(SensorGroup::count)> failing_{}, frozen_{};
  bool hidden_ = false;
};

}  // namespace footfall::hal
