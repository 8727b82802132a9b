// Whether the sensors' data are new, alive and finite, judged before the estimator sees them.
#pragma once

#include <cstdint>

#include "behaviors/compiled/estimator_spec.h"
#include "hal/sensor_fields.h"
#include "model/robot/description.h"

namespace footfall::engine {

// What one tick found.
struct SensorFindings {
  bool imu_stale = false, mocap_stale = false;
  bool clock = false;     // it jumped, went back, or stands still
  bool infinite = false;  // a value that the estimator uses is NaN or infinite
};

// Judged for every estimator: no new IMU data, no new frame, for longer than the robot's limits;
// the clock. Only for an estimator that needs the sensor: data that stay the same to the last bit
// although they are said to be new (frozen: a resolution hides no motion for that long), frames
// with fewer than three markers or that it does not use (too old), values that are not finite. A
// clock that stands still is told only if it has moved before: a backend may have none. Likewise a
// perfect IMU and motion capture: at rest they never change.
//
// A read that brings nothing at all is another fault, too, sensor.stale: the ages grow in it.
class SensorWatch {
 public:
  SensorWatch(const behaviors::EstimatorSpec& spec, const model::RobotDescription& robot);

  // Once a tick, after the read. `fresh`: the read brought something new.
  SensorFindings check(const hal::Sensors& sensors, bool fresh) noexcept;
  // What the estimator gets: the sensors as they are or, while a value that it uses is not finite,
  // a copy in which the last good one stands and its group is not new (a marker: not seen), and
  // while motion capture repeats a frame, or a read brought nothing, one without a frame.
  const hal::Sensors& usable() const noexcept { return *usable_; }

  // After the estimate: how many markers the estimator used of this tick's frame, if there is one.
  void used(int markers) noexcept;

  // Goes on from the watch of another loop on the same robot.
  void take_over(const SensorWatch& old) noexcept;

 private:
  void watch_clock(const hal::Sensors& sensors, SensorFindings& findings) noexcept;
  void watch_imu(const hal::Sensors& sensors) noexcept;
  void watch_mocap(const hal::Sensors& sensors) noexcept;
  void hide_frame(const hal::Sensors& sensors) noexcept;
  bool repair(const hal::Sensors& sensors) noexcept;

  bool needs_state_, needs_imu_, needs_mocap_, needs_torque_;
  std::size_t joints_;
  std::int64_t period_ns_, imu_limit_, mocap_limit_;  // limits: ticks
  // Since the last good data.
  std::int64_t imu_ticks_ = 0, mocap_ticks_ = 0, clock_ticks_ = 0;
  bool imu_moved_ = false, mocap_moved_ = false, clock_moved_ = false, started_ = false;
  bool imu_known_ = false, mocap_known_ = false;
  hal::Sensors last_;      // fresh ones, all values finite: of each group the last good ones
  hal::Sensors repaired_;  // what usable() gives while values are not finite
  bool spoiled_ = false;   // there are such values
  bool frame_ = false;     // of this tick: new, with enough markers
  const hal::Sensors* usable_ = &repaired_;
};

}  // namespace footfall::engine
