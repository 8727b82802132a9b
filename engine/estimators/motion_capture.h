// State from IMU, motion capture and leg kinematics: [Kim16] Appendix C with the corrections E15 to
// E18 for the orientation; position and velocity by the accelerometer, corrected by the legs and by
// frames of motion capture. docs/estimation.md has the equations.
#pragma once

#include <vector>

#include "engine/estimators/measured.h"
#include "engine/estimators/parts/marker_fit.h"
#include "engine/estimators/parts/motion_history.h"

namespace footfall::engine {

// In the order of the table in behaviors/language/estimators.cc, after measured_parameter.
namespace motion_capture_parameter {
enum : std::size_t {
  lambda = measured_parameter::count,
  gyro_bias_gain,
  oldest_frame,
  position_gain,
  velocity_gain,
  leg_velocity_time,
  acceleration_gain,
  regain_after,
  marker_gate,
  count,
};
}  // namespace motion_capture_parameter

// No state before the first frame with three markers that agree and are not on a line. Afterwards
// it goes on without frames: the position then drifts with the legs.
class MotionCapture final : public Estimator {
 public:
  MotionCapture(const behaviors::EstimatorSpec& spec, const model::RobotDescription& robot,
                const model::ControlModel& model);
  bool estimate(const EstimatorInput& input, Estimate& estimate) noexcept override;
  void take_over(const Estimator& old, const Estimate& last) noexcept override;

 private:
  // Of the base; v and dv at the IMU, so that the gyro's noise does not move them.
  struct Memory {
    explicit Memory(double period) : history(period) {}
    bool started = false;
    Matrix3d R = Matrix3d::Identity();         // R_WB
    Vector3d gyro_bias = Vector3d::Zero();     // rad/s, base axes
    Vector3d position = Vector3d::Zero();      // m, world, base origin
    Vector3d velocity = Vector3d::Zero();      // m/s, world, of the IMU
    Vector3d acceleration = Vector3d::Zero();  // m/s^2, world, correction of the accelerometer
    MotionHistory history;
    double frame_time = 0.0;  // s since the last frame used
    int markers = 0;          // of the last frame
  };

  int collect_markers(const hal::Sensors& sensors) noexcept;
  bool start(const EstimatorInput& input) noexcept;
  void predict() noexcept;
  void correct_by_legs(std::span<const double> parameters, EstimateQuality& quality) noexcept;
  void correct_by_frame(const EstimatorInput& input, EstimateQuality& quality) noexcept;
  bool regain(std::span<MarkerPair> seen, double gate, const Motion& motion) noexcept;
  void correct_place(std::span<const double> parameters, const Vector3d& error,
                     double interval) noexcept;
  void write(Estimate& estimate) const noexcept;
  Vector3d arm_velocity() const noexcept {  // of the IMU against the base's origin, m/s, world
    return memory_.R * rate_.cross(measured_.imu());
  }

  Measured measured_;
  double gravity_;
  std::vector<Vector3d> places_;  // of the markers, m, base frame
  std::array<MarkerPair, core::kMaxMarkers> pairs_{};
  Vector3d rate_ = Vector3d::Zero();  // rad/s, base axes, of this tick
  Memory memory_;
};

}  // namespace footfall::engine
