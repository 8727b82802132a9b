// Gyroscope and accelerometer. A sample is the mean over the tick, as of a digital IMU that gives
// delta angles and delta velocities (Savage 1998, eq. (7) and (16)), R_BI from IMU to base axes:
//
//   gyro          = R_IB log(R(t-T)ᵀ R(t)) / T
//   accelerometer = R_IB R(t-T/2)ᵀ ((v_I(t) - v_I(t-T)) / T - g),   v_I = v_B + R (ω × p_BI)
//
// plus a bias and white noise: R(t) = R(t-T) exp(gyro T) is exact.
#pragma once

#include "hal/sensors/errors.h"
#include "hal/sensors/noise.h"

namespace footfall::hal {

class Imu {
 public:
  // `period`: s, of the tick.
  Imu(const ImuErrors& errors, const SensorPlaces& places, double period, std::uint64_t seed);

  // At a start the motion before was the same: the mean rate is the present one, no acceleration.
  void start(const BaseMotion& motion) noexcept;
  // One call a tick. Without errors the values are exact; else they are digital().
  void sample(const BaseMotion& motion, std::array<double, 3>& gyro,
              std::array<double, 3>& accelerometer) noexcept;

  const std::array<double, 3>& gyro_bias() const noexcept { return gyro_.bias.value; }
  const std::array<double, 3>& accelerometer_bias() const noexcept {
    return accelerometer_.bias.value;
  }

 private:
  // Errors of three axes.
  struct Axes {
    InertialErrors errors;
    NoiseStream noise, walk;
    RandomWalk bias;
    Axes(const InertialErrors& errors, std::uint64_t seed, NoiseSource noise, NoiseSource bias,
         NoiseSource walk);
    void add_to(std::array<double, 3>& value, double period) noexcept;
  };
  std::array<double, 3> velocity(const BaseMotion& motion) const noexcept;

  SensorPlaces places_;
  double period_;
  bool errors_;
  Axes gyro_, accelerometer_;
  std::array<double, 9> R_BI_{};  // with the mount's error
  BaseMotion before_;
  std::array<double, 3> velocity_before_{};  // of the IMU
  bool started_ = false;                     // a sample was taken
};

}  // namespace footfall::hal
