// Hume and seeded states of it, for tests of the model and of the whole-body controller.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/diagnostics/diagnostics.h"
#include "model/control_model.h"
#include "model/robot/description.h"

namespace footfall::tests {

inline model::RobotDescription load_hume() {
  core::Diagnostics diagnostics;
  model::RobotDescription robot =
      model::load_robot(std::string(FOOTFALL_SOURCE_DIR) + "/robots/hume/robot.yaml", diagnostics);
  if (diagnostics.has_errors()) throw std::runtime_error("robots/hume/robot.yaml has errors");
  return robot;
}

// Uniform numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double within(double limit) {
    const auto bits = static_cast<double>(engine_() >> 11);
    return limit * (2.0 * bits / 9007199254740992.0 - 1.0);  // 2^53
  }

 private:
  std::mt19937_64 engine_;
};

struct StateSpread {
  double joint = 0.15;       // rad about the nominal posture
  double tilt = 0.1;         // rad
  double yaw = 3.1;          // rad
  double place = 0.5;        // m
  double speed = 0.5;        // m/s and rad/s of the base
  double joint_speed = 1.0;  // rad/s
};

// Standing at the nominal posture, at rest, at the origin.
inline model::State standing_state(const model::RobotDescription& robot) {
  model::State s;
  s.p_WB = {0.0, 0.0, robot.standing_height};
  for (std::size_t j = 0; j < robot.joints.size(); ++j) s.q[j] = robot.joints[j].posture;
  return s;
}

// A moving state near standing; any heading.
inline model::State random_state(const model::RobotDescription& robot, Random& random,
                                 const StateSpread& spread = {}) {
  model::State s = standing_state(robot);
  for (double& p : s.p_WB) p += random.within(spread.place) * 0.1;
  const double roll = random.within(spread.tilt), pitch = random.within(spread.tilt),
               yaw = random.within(spread.yaw);
  const double cr = std::cos(roll / 2), sr = std::sin(roll / 2);
  const double cp = std::cos(pitch / 2), sp = std::sin(pitch / 2);
  const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
  s.q_WB = {cy * cp * cr + sy * sp * sr, cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr,
            sy * cp * cr - cy * sp * sr};
  for (double& v : s.v_WB) v = random.within(spread.speed);
  for (double& w : s.w_WB_B) w = random.within(spread.speed);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    s.q[j] += random.within(spread.joint);
    s.qd[j] = random.within(spread.joint_speed);
  }
  return s;
}

// The state after `dt` at constant generalised velocity (base rotation on the group).
inline model::State integrated(const model::State& from, double dt, int joints) {
  model::State s = from;
  for (std::size_t k = 0; k < 3; ++k) s.p_WB[k] += dt * from.v_WB[k];
  const auto& w = from.w_WB_B;
  const double speed = std::hypot(w[0], w[1], w[2]);
  const double half = 0.5 * speed * dt;
  const double scale = speed > 0.0 ? std::sin(half) / speed : 0.0;
  const double a0 = std::cos(half), a1 = scale * w[0], a2 = scale * w[1], a3 = scale * w[2];
  const auto& q = from.q_WB;
  s.q_WB = {
      q[0] * a0 - q[1] * a1 - q[2] * a2 - q[3] * a3, q[0] * a1 + q[1] * a0 + q[2] * a3 - q[3] * a2,
      q[0] * a2 - q[1] * a3 + q[2] * a0 + q[3] * a1, q[0] * a3 + q[1] * a2 - q[2] * a1 + q[3] * a0};
  for (std::size_t j = 0; j < static_cast<std::size_t>(joints); ++j) s.q[j] += dt * from.qd[j];
  return s;
}

}  // namespace footfall::tests
