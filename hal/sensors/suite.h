// All sensors of a robot with their errors, for backends without real ones.
#pragma once

#include "hal/sensor_fields.h"
#include "hal/sensors/encoders.h"
#include "hal/sensors/imu.h"
#include "hal/sensors/mocap.h"
#include "hal/sensors/switches.h"

namespace footfall::hal {

// What a backend knows of a tick beside the base's truth in `Sensors`.
struct SensorTruth {
  std::array<double, core::kMaxJoints> q{};               // rad
  std::array<double, core::kMaxJoints> qd{};              // rad/s
  std::array<double, core::kMaxContacts> normal_force{};  // N, of the ground
  std::array<double, 3> com{};                            // m, world
  std::array<double, 3> com_velocity{};                   // m/s, world
};

class SensorSuite {
 public:
  // `period`: s, of the tick. Throws std::runtime_error for a delay that is too long.
  SensorSuite(const SensorErrors& errors, const SensorPlaces& places, double period,
              std::uint64_t seed);

  // Whether SensorTruth needs more than normal forces.
  bool has_errors() const noexcept { return any_; }
  // All streams begin anew: two runs of one seed are equal bit for bit.
  void start(const BaseMotion& motion);
  // One call a tick. `sensors` comes with the base's truth and with the joints that perfect
  // encoders would give; goes with what the sensors give. No allocation.
  void sample(const SensorTruth& truth, Sensors& sensors) noexcept;

 private:
  void tell_truth(const SensorTruth& truth, Sensors& sensors) const noexcept;

  SensorErrors errors_;
  SensorPlaces places_;
  double period_;
  std::uint64_t seed_;
  bool any_;
  Encoders encoders_;
  Imu imu_;
  Mocap mocap_;
  Switches switches_;
};

}  // namespace footfall::hal
