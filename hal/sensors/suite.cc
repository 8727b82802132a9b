// All sensors of a tick; see suite.h.
#include "hal/sensors/suite.h"

#include <algorithm>

namespace footfall::hal {

SensorSuite::SensorSuite(const SensorErrors& errors, const SensorPlaces& places, double period,
                         std::uint64_t seed)
    : errors_(errors),
      places_(places),
      period_(period),
      seed_(seed),
      any_(errors.any()),
      encoders_(errors.joint_resolution, places.joints, period),
      imu_(errors.imu, places, period, seed),
      mocap_(errors.mocap, places, period, seed),
      switches_(errors.switches, places, period, seed) {}

void SensorSuite::start(const BaseMotion& motion) {
  encoders_.start();
  imu_ = Imu(errors_.imu, places_, period_, seed_);
  imu_.start(motion);
  mocap_ = Mocap(errors_.mocap, places_, period_, seed_);
  mocap_.start(motion);
  switches_ = Switches(errors_.switches, places_, period_, seed_);
  switches_.start();
}

void SensorSuite::tell_truth(const SensorTruth& truth, Sensors& s) const noexcept {
  s.sensor_truth = any_;
  if (!any_) return;
  std::copy_n(truth.q.begin(), places_.joints, s.true_q.begin());
  std::copy_n(truth.qd.begin(), places_.joints, s.true_qd.begin());
  s.true_com = truth.com;
  s.true_com_velocity = truth.com_velocity;
  s.true_gyro_bias = imu_.gyro_bias();
  s.true_accelerometer_bias = imu_.accelerometer_bias();
}

void SensorSuite::sample(const SensorTruth& truth, Sensors& s) noexcept {
  const BaseMotion motion = {s.p_WB, s.q_WB, s.v_WB, s.w_WB_B};
  const auto joints = static_cast<std::size_t>(places_.joints);
  encoders_.sample({s.q.data(), joints}, {s.qd.data(), joints});
  imu_.sample(motion, s.gyro, s.accelerometer);
  s.imu_fresh = true;
  s.mocap_fresh = true;
  if (places_.markers > 0) mocap_.sample(motion, s);
  switches_.sample(truth.normal_force, s.contact);
  tell_truth(truth, s);
}

}  // namespace footfall::hal
