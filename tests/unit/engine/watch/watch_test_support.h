// A sensor watch, its sensors and a clock.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "engine/watch/sensor_watch.h"

namespace footfall::tests {

using behaviors::EstimatorType;
using engine::SensorFindings;
using engine::SensorWatch;

// A watch on a robot of 1 kHz whose IMU and motion capture move in every tick.
class WatchTest : public testing::Test {
 protected:
  WatchTest() {
    robot_.rate_mhz = 1'000'000;
    robot_.imu_age = 5e-3;
    robot_.mocap_age = 10e-3;
    robot_.joints.resize(2);
  }
  void watch(EstimatorType type,
             behaviors::ContactSource contact = behaviors::ContactSource::switches) {
    watch_.emplace(behaviors::EstimatorSpec{.type = type, .contact = contact}, robot_);
  }
  SensorFindings tick(const std::function<void(hal::Sensors&)>& change = nullptr,
                      bool fresh = true) {
    ++tick_;
    const auto t = static_cast<double>(tick_);
    sensors_.time_ns = tick_ * 1'000'000;
    sensors_.gyro = {t, 0.0, 0.0};
    sensors_.accelerometer = {0.0, 0.0, 9.81 + 1e-3 * t};
    for (std::size_t m = 0; m < 4; ++m) {
      sensors_.marker[m] = {t, 0.1 * static_cast<double>(m), 1.0};
      sensors_.marker_seen[m] = true;
    }
    sensors_.imu_fresh = sensors_.mocap_fresh = true;
    sensors_.q = {1e-3 * t, 0.0};
    if (change) change(sensors_);
    const SensorFindings found = watch_->check(sensors_, fresh);
    watch_->used(used_);
    commands_.tau[0] += driven_ ? 1.0 : 0.0;
    watch_->commanded(commands_);
    return found;
  }
  // Ticks with this change until the finding, at most 100.
  int ticks_until(bool SensorFindings::*finding, const std::function<void(hal::Sensors&)>& change) {
    for (int k = 1; k <= 100; ++k) {
      if (tick(change).*finding) return k;
    }
    return -1;
  }

  model::RobotDescription robot_;
  std::optional<SensorWatch> watch_;
  hal::Sensors sensors_;
  std::int64_t tick_ = 0;
  int used_ = 4;  // markers by the estimator
  hal::Commands commands_;
  bool driven_ = true;  // commands change in every tick
};

}  // namespace footfall::tests
