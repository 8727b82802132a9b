// The robot seen from the tick: what is read, what is written, and the interface of every backend.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/fault.h"
#include "core/limits.h"

namespace footfall::hal {

// Measured once a tick. Arrays are in the robot file's order; unused entries are 0.
struct Sensors {
  std::int64_t time_ns = 0;                                       // backend's clock at sampling
  std::array<double, core::kMaxJoints> q{};                       // joint position, rad
  std::array<double, core::kMaxJoints> qd{};                      // joint velocity, rad/s
  std::array<double, core::kMaxJoints> tau{};                     // joint torque measured, N m
  std::array<double, 3> gyro{};                                   // rad/s, IMU frame
  std::array<double, 3> accelerometer{};                          // m/s^2, IMU frame
  std::array<bool, core::kMaxContacts> contact{};                 // foot switch closed
  std::array<std::array<double, 3>, core::kMaxContacts> force{};  // N, ground on robot, world

  bool imu_fresh = true;    // the IMU's data are new
  bool mocap_fresh = true;  // motion capture's are

  bool has_truth = false;                  // a simulator tells the base's true state
  std::array<double, 3> p_WB{};            // base origin, m, world
  std::array<double, 4> q_WB{1, 0, 0, 0};  // base orientation, w x y z
  std::array<double, 3> v_WB{};            // velocity of the base origin, m/s, world
  std::array<double, 3> w_WB_B{};          // angular velocity, rad/s, base frame

  bool body_contact = false;   // something other than a declared contact touches (simulator)
  bool backend_fault = false;  // the backend raised a warning or reset itself (simulator)
};

// Written once a tick.
struct Commands {
  std::array<double, core::kMaxJoints> tau{};  // joint torque, N m
};

// A backend. start() may throw std::runtime_error with one clear sentence; the rest may not.
class Hardware {
 public:
  virtual ~Hardware() = default;
  virtual std::string name() const = 0;
  virtual void start() = 0;
  // Samples all sensors; false: nothing new arrived.
  virtual bool read(Sensors& sensors) noexcept = 0;
  // Applies the commands; a lock-step simulation then advances by one control period.
  virtual void write(const Commands& commands) noexcept = 0;
  // Brings the robot into its safest passive condition; always works, any number of times.
  virtual void safe_stop() noexcept = 0;
  // Whether its actuators have a torque loop whose gains a behavior's `torque_loop:` can set.
  virtual bool uses_torque_loop() const { return false; }
};

}  // namespace footfall::hal
