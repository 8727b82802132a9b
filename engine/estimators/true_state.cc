// Copies the true state from the sensors; see true_state.h.
#include "engine/estimators/true_state.h"

#include <algorithm>

namespace footfall::engine {

bool TrueState::estimate(const hal::Sensors& sensors, model::State& state) noexcept {
  if (!sensors.has_truth) return false;
  state.p_WB = sensors.p_WB;
  state.q_WB = sensors.q_WB;
  state.v_WB = sensors.v_WB;
  state.w_WB_B = sensors.w_WB_B;
  std::copy_n(sensors.q.begin(), joints_, state.q.begin());
  std::copy_n(sensors.qd.begin(), joints_, state.qd.begin());
  return true;
}

}  // namespace footfall::engine
