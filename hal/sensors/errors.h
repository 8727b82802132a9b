// How far the robot's sensors are from perfect: plain numbers, SI. 0 is perfect everywhere.
#pragma once

#include <array>

#include "core/capacities.h"

namespace footfall::hal {

// Of a gyroscope (rad/s) or an accelerometer (m/s^2), each of its axes.
struct InertialErrors {
  double noise = 0.0;  // standard deviation of a sample, white
  double bias = 0.0;   // magnitude of the constant offset; its sign is drawn
  double walk = 0.0;  // standard deviation of the bias's change in 1 s; grows with the root of time
  bool any() const noexcept { return noise > 0.0 || bias > 0.0 || walk > 0.0; }
};

struct ImuErrors {
  InertialErrors gyro{}, accelerometer{};
  double mount = 0.0;  // rad, standard deviation of its orientation error about each axis
  bool any() const noexcept { return gyro.any() || accelerometer.any() || mount > 0.0; }
};

struct MocapErrors {
  double rate = 0.0;       // Hz, of frames; 0: one each tick
  double delay = 0.0;      // s, from exposure to arrival
  double noise = 0.0;      // m, standard deviation of a coordinate, white
  double occlusion = 0.0;  // part of the time in which a marker is hidden, 0..1
  double spell = 0.1;      // s, mean duration of such a time
  double dropped = 0.0;    // probability that a frame never arrives, 0..1
  double placement = 0.0;  // m, standard deviation of a marker's place on the base, a coordinate
  bool any() const noexcept {
    return rate > 0.0 || delay > 0.0 || noise > 0.0 || occlusion > 0.0 || dropped > 0.0 ||
           placement > 0.0;
  }
};

struct SwitchErrors {
  double threshold = 0.0;  // N, normal force above which a switch closes
  double delay = 0.0;      // s, from there, and from its end, to the report
  double jitter = 0.0;     // s, added to the delay: uniform from 0, drawn for each change
  double bounce = 0.0;     // s, after a touchdown is reported: open or closed at random
  bool any() const noexcept {
    return threshold > 0.0 || delay > 0.0 || jitter > 0.0 || bounce > 0.0;
  }
};

struct SensorErrors {
  double joint_resolution = 0.0;  // rad, of the joints' encoders
  ImuErrors imu;
  MocapErrors mocap;
  SwitchErrors switches;
  bool any() const noexcept {
    return joint_resolution > 0.0 || imu.any() || mocap.any() || switches.any();
  }
  // Whether two seeds differ.
  bool random() const noexcept {
    return imu.any() || mocap.noise > 0.0 || mocap.occlusion > 0.0 || mocap.dropped > 0.0 ||
           mocap.placement > 0.0 || switches.jitter > 0.0 || switches.bounce > 0.0;
  }
};

// Where a robot's sensors are, and what it has of them.
struct SensorPlaces {
  int joints = 0;
  int contacts = 0;
  std::array<bool, core::kMaxContacts> has_switch{};      // others report the truth
  bool has_imu = false;                                   // false: the IMU is at the base's origin
  std::array<double, 3> p_BI{};                           // m, base frame
  std::array<double, 9> R_BI{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major, from IMU to base axes
  int markers = 0;
  std::array<std::array<double, 3>, core::kMaxMarkers> p_BM{};  // m, base frame
  std::array<double, 3> gravity{0.0, 0.0, -9.81};               // m/s^2, world
};

// Motion of the base at a tick, from which the IMU and motion capture derive.
struct BaseMotion {
  std::array<double, 3> p_WB{};            // m, world
  std::array<double, 4> q_WB{1, 0, 0, 0};  // w x y z
  std::array<double, 3> v_WB{};            // m/s, world
  std::array<double, 3> w_WB_B{};          // rad/s, base frame
};

}  // namespace footfall::hal
