// Whether the sensors' data are new, alive and finite, judged before the estimator sees them.
#pragma once

#include <array>
#include <cstdint>

#include "behaviors/compiled/estimator_spec.h"
#include "hal/sensor_fields.h"
#include "model/robot/description.h"

namespace footfall::engine {

// What one tick found.
struct SensorFindings {
  bool imu_stale = false, mocap_stale = false;
  bool joints_stale = false;  // frozen
  bool clock = false;         // it jumped, went back, or stands still
  bool infinite = false;      // a value that the estimator uses is NaN or infinite
};

// For how long something that is said to be new has been the same to the last bit.
struct Repeats {
  bool known = false, moved = false, repeated = false, rests = false;
  std::int64_t ticks = 0;  // counted outside
  // `dead`: what has never moved is frozen, too. What has repeated for up to `rest` ticks and went
  // on may rest within its resolution: it is never frozen.
  void next(bool same, bool dead, std::int64_t rest = 0) noexcept {
    same = same && known;
    rests = rests || (!same && repeated && ticks <= rest);
    repeated = same;
    moved = moved || (known && (!same || dead));
    if (!same || !moved || rests) ticks = 0;
    known = true;
  }
};

// Judged for every estimator: no new IMU data, no new frame, for longer than the robot's limits;
// the clock. Only for an estimator that needs the sensor: data that stay the same to the last bit
// although they are said to be new (frozen: a resolution hides no motion for that long), frames
// with fewer than three markers or that it does not use (too old), values that are not finite. A
// clock that stands still is told only if it has moved before: a backend may have none. Likewise
// perfect sensors: at rest they never change.
//
// Gyroscope and accelerometer are judged apart and together; apart, one of a simulator may rest.
// Joints (angles, motors, torques) are frozen if none of them changes for as long as an IMU may,
// from when a command is off by more than the robot's limit torque_step from what it was when one
// did: within their resolution they may rest for any time.
//
// A read that brings nothing at all is another fault, too, sensor.stale: the ages grow in it.
class SensorWatch {
 public:
  SensorWatch(const behaviors::EstimatorSpec& spec, const model::RobotDescription& robot);

  // Once a tick, after the read. `fresh`: the read brought something new.
  SensorFindings check(const hal::Sensors& sensors, bool fresh) noexcept;
  // What the estimator gets: the sensors as they are or a copy in which
  // - while a value that it uses is not finite, the last good one stands and its group is not new
  //   (a marker: not seen),
  // - while motion capture repeats a frame there is none; a marker that alone repeats is not seen,
  // - while reads bring nothing neither the IMU nor motion capture are new.
  const hal::Sensors& usable() const noexcept { return *usable_; }
  // Whether the joints in usable() are a new sample, measured in this tick.
  bool joints_new() const noexcept { return joints_new_; }

  // After the estimate: how many markers the estimator used of this tick's frame, if there is one.
  void used(int markers) noexcept;
  // At the end of a tick: what the joints were told. Without it they are never found frozen.
  void commanded(const hal::Commands& commands) noexcept;

  // Goes on from the watch of another loop on the same robot.
  void take_over(const SensorWatch& old) noexcept;

 private:
  void watch_clock(const hal::Sensors& sensors, SensorFindings& findings) noexcept;
  void watch_joints(const hal::Sensors& sensors) noexcept;
  void watch_imu(const hal::Sensors& sensors) noexcept;
  void watch_mocap(const hal::Sensors& sensors) noexcept;
  int hide_frozen(const hal::Sensors& sensors, int moved) noexcept;
  hal::Sensors& copy(const hal::Sensors& sensors) noexcept;
  void hide_news(const hal::Sensors& sensors) noexcept;
  bool repair(const hal::Sensors& sensors) noexcept;

  bool needs_state_, needs_imu_, needs_mocap_;
  std::size_t joint_count_;
  std::int64_t period_ns_, imu_limit_, mocap_limit_;  // limits: ticks
  // Since the last good data.
  std::int64_t imu_ticks_ = 0, mocap_ticks_ = 0, clock_ticks_ = 0;
  bool mocap_moved_ = false, clock_moved_ = false, started_ = false, mocap_known_ = false;
  Repeats joints_, imu_, gyro_, accelerometer_;
  std::array<std::int64_t, core::kMaxMarkers> marker_ticks_{};
  double torque_step_;                           // N m
  hal::Commands commands_, commands_at_change_;  // of the last tick; when joints changed
  bool driven_ = false;                          // commands have moved since joints did
  hal::Sensors last_;      // fresh ones, all values finite: of each group the last good ones
  hal::Sensors repaired_;  // what usable() gives while it is not the sensors
  bool spoiled_ = false;   // values are not finite: repaired_ has the last read
  bool hidden_ = false;    // reads bring nothing: likewise
  bool joints_new_ = false;
  bool frame_ = false;  // of this tick: new, with enough markers
  const hal::Sensors* usable_ = &repaired_;
};

}  // namespace footfall::engine
