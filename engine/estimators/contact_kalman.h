// State without motion capture, from IMU, joints and contacts: an invariant Kalman filter
// (parts/invariant_filter.h) in the frame where the robot started. Heading and place drift; their
// standard deviations say how far. Without a foot that keeps its place for longer than `lost_after`
// there is no estimate: accelerometer alone is wrong by metres within seconds.
#pragma once

#include <memory>

#include "behaviors/compiled/estimator_spec.h"
#include "engine/estimators/estimator.h"
#include "engine/estimators/measured.h"
#include "model/robot/description.h"

namespace footfall::engine {

// In the order of the table in behaviors/language/estimators.cc, after measured_parameter.
namespace contact_kalman_parameter {
enum : std::size_t {
  gyro_noise = measured_parameter::count,
  accelerometer_noise,
  gyro_bias_walk,
  accelerometer_bias_walk,
  foot_noise,
  foot_slip,
  slip_gate,
  ground_noise,
  start_attitude,
  start_velocity,
  start_gyro_bias,
  start_accelerometer_bias,
  lost_after,
  count,
};
}  // namespace contact_kalman_parameter

// It holds on to the robot's first 2, 4 or 8 contacts, as many as it has. Throws std::runtime_error
// if the robot has no IMU or no contact.
std::unique_ptr<Estimator> make_contact_kalman(const behaviors::EstimatorSpec& spec,
                                               const model::RobotDescription& robot,
                                               const model::ControlModel& model);

}  // namespace footfall::engine
