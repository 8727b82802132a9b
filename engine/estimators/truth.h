// The true state that a simulator tells beside the sensors, for comparison with the estimate.
#pragma once

#include <array>

#include "hal/sensor_fields.h"
#include "model/control_model.h"
#include "model/state.h"

namespace footfall::engine {

struct Truth {
  std::array<double, 3> p_WB{}, v_WB{};  // m, m/s, world
  std::array<double, 3> rpy{};           // rad, R_WB = Rz Ry Rx
  std::array<double, 3> com{};           // m, world
};

// Roll, pitch and yaw of a unit quaternion w x y z, R = Rz Ry Rx, rad.
std::array<double, 3> rpy_of(const std::array<double, 4>& q_WB) noexcept;

// Of sensors with has_truth. `model` is updated with the estimate: where sensors have no errors the
// CoM has the same place in the base frame in truth. Allocates nothing.
Truth truth_of(const hal::Sensors& sensors, const model::ControlModel& model) noexcept;

// The truth as a state of the control model; of a simulator's sensors.
model::State true_state(const hal::Sensors& sensors) noexcept;

}  // namespace footfall::engine
