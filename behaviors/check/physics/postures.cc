// Nominal and seeded postures; see postures.h.
#include "behaviors/check/physics/postures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "core/random.h"

namespace footfall::behaviors {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kJointSpread = 0.2;  // rad
constexpr double kTilt = 0.1;         // rad
constexpr double kYaw = 0.5;          // rad

// Uniform within ±limit.
double within(double limit, std::mt19937_64& engine) {
  return limit * (2.0 * core::uniform(engine) - 1.0);
}

std::array<double, 4> quaternion(double roll, double pitch, double yaw) {
  const double cr = std::cos(roll / 2), sr = std::sin(roll / 2);
  const double cp = std::cos(pitch / 2), sp = std::sin(pitch / 2);
  const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
  return {cy * cp * cr + sy * sp * sr, cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr,
          sy * cp * cr - cy * sp * sr};
}

}  // namespace

std::vector<model::State> physics_postures(const model::RobotDescription& robot) {
  model::State nominal;
  nominal.p_WB = {0.0, 0.0, robot.standing_height};
  for (std::size_t j = 0; j < robot.joints.size(); ++j) nominal.q[j] = robot.joints[j].posture;
  std::vector<model::State> postures = {nominal};
  std::mt19937_64 engine(kSeed);
  for (int k = 0; k < kSeededPostures; ++k) {
    model::State state = nominal;
    const double roll = within(kTilt, engine);
    const double pitch = within(kTilt, engine);
    state.q_WB = quaternion(roll, pitch, within(kYaw, engine));
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const auto& joint = robot.joints[j];
      state.q[j] = std::clamp(joint.posture + within(kJointSpread, engine), joint.position_min,
                              joint.position_max);
    }
    postures.push_back(state);
  }
  return postures;
}

}  // namespace footfall::behaviors
