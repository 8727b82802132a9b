// The robot as the tick sees it: sensors, commands, and the interface of every backend.
#pragma once

#include <cstdint>
#include <string>

#include "core/capacities.h"
#include "core/fault.h"
#include "hal/sensor_fields.h"
#include "hal/torque_loop_gains.h"

namespace footfall::hal {

// A backend. start() may throw std::runtime_error with one clear sentence; the rest may not.
class Hardware {
 public:
  virtual ~Hardware() = default;
  virtual std::string name() const = 0;
  virtual void start() = 0;
  // Samples all sensors; false if no new data arrived.
  virtual bool read(Sensors& sensors) noexcept = 0;
  // Applies the commands; a lock-step simulation then advances by one control period.
  virtual void write(const Commands& commands) noexcept = 0;
  // Brings the robot into its safest passive condition; always works, can be repeated.
  virtual void safe_stop() noexcept = 0;
  // Whether its actuators have a torque loop whose gains a behavior's `torque_loop:` can set.
  virtual bool uses_torque_loop() const { return false; }
  // Contacts that the control law relies on or loads from now on: bit c of contact c. Only a stand
  // without a ground needs to know.
  virtual void set_support(std::uint64_t contacts) noexcept { (void)contacts; }
  // Gains of a joint's torque loop from the next write() on; the motor's torque stays continuous.
  virtual void set_torque_loop(int joint, const TorqueLoopGains& gains) noexcept {
    (void)joint;
    (void)gains;
  }
};

}  // namespace footfall::hal
