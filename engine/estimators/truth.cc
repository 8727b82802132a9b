// From a simulator's own state; see truth.h.
#include "engine/estimators/truth.h"

#include <algorithm>
#include <cmath>

namespace footfall::engine {
namespace {

// R(q) v.
std::array<double, 3> rotated(const std::array<double, 4>& q,
                              const std::array<double, 3>& v) noexcept {
  const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                 a[0] * b[1] - a[1] * b[0]};
  };
  const std::array<double, 3> u = {q[1], q[2], q[3]};
  const auto first = cross(u, v);
  const auto second = cross(u, first);
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = v[k] + 2.0 * (q[0] * first[k] + second[k]);
  return out;
}

}  // namespace

std::array<double, 3> rpy_of(const std::array<double, 4>& q) noexcept {
  const auto [w, x, y, z] = q;
  return {std::atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
          std::asin(std::clamp(2.0 * (w * y - z * x), -1.0, 1.0)),
          std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))};
}

Truth truth_of(const hal::Sensors& sensors, const model::ControlModel& model) noexcept {
  Truth truth{sensors.p_WB, sensors.v_WB, rpy_of(sensors.q_WB), sensors.true_com};
  if (sensors.sensor_truth) return truth;
  const auto& R = model.R_WB();
  const auto& com = model.com().position;
  const auto& origin = model.state().p_WB;
  std::array<double, 3> in_base{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) in_base[i] += R[3 * k + i] * (com[k] - origin[k]);
  }
  truth.com = rotated(sensors.q_WB, in_base);
  for (std::size_t k = 0; k < 3; ++k) truth.com[k] += sensors.p_WB[k];
  return truth;
}

model::State true_state(const hal::Sensors& sensors) noexcept {
  model::State state;
  state.p_WB = sensors.p_WB;
  state.q_WB = sensors.q_WB;
  state.v_WB = sensors.v_WB;
  state.w_WB_B = sensors.w_WB_B;
  state.q = sensors.sensor_truth ? sensors.true_q : sensors.q;
  state.qd = sensors.sensor_truth ? sensors.true_qd : sensors.qd;
  return state;
}

}  // namespace footfall::engine
