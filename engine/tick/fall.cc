// Height, tilt, touch; see fall.h.
#include "engine/tick/fall.h"

#include <algorithm>
#include <cmath>

namespace footfall::engine {
namespace {

// The true vertical in the base's axes: where the estimated points lie above the base in truth.
struct UpInBase {
  explicit UpInBase(const std::array<double, 4>& q)
      : x(2.0 * (q[1] * q[3] - q[0] * q[2])),
        y(2.0 * (q[2] * q[3] + q[0] * q[1])),
        z(1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])) {}
  double height_of(const model::ControlModel& model,
                   const std::array<double, 3>& point) const noexcept {
    const std::array<double, 9>& R = model.R_WB();
    const std::array<double, 3>& base = model.state().p_WB;
    const double dx = point[0] - base[0], dy = point[1] - base[1], dz = point[2] - base[2];
    return x * (R[0] * dx + R[3] * dy + R[6] * dz) + y * (R[1] * dx + R[4] * dy + R[7] * dz) +
           z * (R[2] * dx + R[5] * dy + R[8] * dz);
  }
  double x, y, z;
};

}  // namespace

FallCriteria judge_fall(const model::RobotDescription& robot, const hal::Sensors& sensors,
                        const model::ControlModel& model) noexcept {
  FallCriteria fall;
  const double base = model.state().p_WB[2];
  double ground = base;
  for (int c = 0; c < model.contact_count(); ++c) {
    ground = std::min(ground, model.point(c).position[2]);
  }
  fall.height = base - ground;
  fall.upright = model.R_WB()[8];
  if (sensors.has_truth) {
    const UpInBase up(sensors.q_WB);
    fall.upright = std::min(fall.upright, up.z);
    double below = 0.0;
    for (int c = 0; c < model.contact_count(); ++c) {
      below = std::min(below, up.height_of(model, model.point(c).position));
    }
    fall.height = std::min(fall.height, -below);
  }
  fall.height_limit = robot.height_limit * robot.standing_height;
  fall.low =
      model.contact_count() > 0 && robot.standing_height > 0.0 && fall.height < fall.height_limit;
  fall.tilt_limit = robot.tilt_limit;
  fall.tilted = fall.upright < std::cos(robot.tilt_limit);
  fall.touching = sensors.body_contact;
  return fall;
}

}  // namespace footfall::engine
