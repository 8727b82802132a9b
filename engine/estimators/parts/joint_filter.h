// Joint positions and velocities from encoders, motors and measured torques; all estimators that
// measure use it.
//
// Where a joint has a series-elastic actuator, q_m = motor - tau / spring is the joint's position
// as finely as the motor's encoder tells it. `tau` is the nominal spring times the measured
// deflection, so that a spring that is not nominal does not change q_m. What the two encoders
// differ by slowly (play, zero) is taken from the joint's own:
//   position = q_m + low-pass(q_encoder - q_m; encoder_time)
//   velocity = low-pass(dq_m / dt; joint_velocity_filter)
// Without such an actuator, or where motors are not reported (hal::Sensors::has_motors):
//   position = q_encoder, velocity = low-pass(qd; joint_velocity_filter).
#pragma once

#include <array>

#include "core/capacities.h"
#include "hal/sensor_fields.h"
#include "model/robot/description.h"
#include "model/state.h"

namespace footfall::engine {

class JointFilter {
 public:
  explicit JointFilter(const model::RobotDescription& robot);
  // Time constants in s, 0: none. Writes q and qd. The first call has velocities of the sensors.
  // Not `fresh`: the sensors have no new values; the joints go on as they moved, and the next rate
  // is the mean since the last sample.
  void update(const hal::Sensors& sensors, bool fresh, double velocity_filter, double encoder_time,
              model::State& state) noexcept;
  int count() const noexcept { return count_; }

 private:
  int count_;
  double period_;
  std::array<double, core::kMaxJoints> compliance_{};  // rad/(N m); 0: no spring
  std::array<double, core::kMaxJoints> last_{};        // q_m, rad
  std::array<double, core::kMaxJoints> offset_{};      // rad
  std::array<double, core::kMaxJoints> rate_{};        // rad/s
  int ticks_ = 0;                                      // since the last sample
  bool started_ = false;
  bool motors_ = false;  // they are reported
};

// Share of the new value in a first-order low-pass, exact for an input constant over the tick.
double low_pass_share(double period, double time_constant) noexcept;

}  // namespace footfall::engine
