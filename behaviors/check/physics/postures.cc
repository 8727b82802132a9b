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

// Puts the base where the first ball rests on the ground below it.
void let_down(model::ControlModel& model, model::State& state) {
  model.update(state);
  double lift = -1e9;
  for (int c = 0; c < model.contact_count(); ++c) {
    const double radius = model.contact_radius(c);
    std::array<double, 3> ball = model.point_position(c);
    for (std::size_t k = 0; k < 3; ++k) ball[k] += radius * model.contact_normal(c)[k];
    lift = std::max(lift, model.terrain().rest_height(ball[0], ball[1], radius) - ball[2]);
  }
  if (model.contact_count() > 0) state.p_WB[2] += lift;
}

}  // namespace

std::vector<model::State> physics_postures(const model::RobotDescription& robot,
                                           model::ControlModel& model, const PhysicsWorld& world) {
  model::State nominal;
  nominal.p_WB = {0.0, 0.0, robot.standing_height};
  for (std::size_t j = 0; j < robot.joints.size(); ++j) nominal.q[j] = robot.joints[j].posture;
  bool placed = !world.terrain.boxes.empty();
  if (world.start_joints) {
    const std::vector<double> beside = world.start_joints(robot);
    for (std::size_t j = 0; j < beside.size(); ++j) {
      nominal.q[j] += beside[j];
      placed = placed || beside[j] != 0.0;
    }
  }
  if (placed) let_down(model, nominal);
  std::vector<model::State> postures = {nominal};
  std::mt19937_64 engine(kSeed);
  for (int k = 0; k < kSeededPostures; ++k) {
    model::State state = nominal;
    const double roll = within(kTilt, engine);
    const double pitch = within(kTilt, engine);
    state.q_WB = quaternion(roll, pitch, within(kYaw, engine));
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const auto& joint = robot.joints[j];
      state.q[j] = std::clamp(nominal.q[j] + within(kJointSpread, engine), joint.position_min,
                              joint.position_max);
    }
    if (placed) let_down(model, state);
    postures.push_back(state);
  }
  return postures;
}

}  // namespace footfall::behaviors
