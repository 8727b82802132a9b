// Copies the true state from the sensors; see true_state.h.
#include "engine/estimators/true_state.h"

#include <algorithm>

namespace footfall::engine {

bool TrueState::estimate(const EstimatorInput& input, Estimate& estimate) noexcept {
  const hal::Sensors& sensors = input.sensors;
  if (!sensors.has_truth) return false;
  model::State& state = estimate.state;
  state.p_WB = sensors.p_WB;
  state.q_WB = sensors.q_WB;
  state.v_WB = sensors.v_WB;
  state.w_WB_B = sensors.w_WB_B;
  const bool exact = !sensors.sensor_truth;
  std::copy_n((exact ? sensors.q : sensors.true_q).begin(), joints_, state.q.begin());
  std::copy_n((exact ? sensors.qd : sensors.true_qd).begin(), joints_, state.qd.begin());
  std::copy_n(sensors.contact.begin(), contacts_, estimate.contact.begin());
  return true;
}

}  // namespace footfall::engine
