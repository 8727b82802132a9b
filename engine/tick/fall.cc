// Height, tilt, touch; see fall.h.
#include "engine/tick/fall.h"

#include <algorithm>
#include <cmath>

namespace footfall::engine {

FallCriteria judge_fall(const model::RobotDescription& robot, const hal::Sensors& sensors,
                        const model::ControlModel& model) noexcept {
  FallCriteria fall;
  const double base = model.state().p_WB[2];
  double ground = base;
  for (int c = 0; c < model.contact_count(); ++c) {
    ground = std::min(ground, model.point(c).position[2]);
  }
  fall.height = base - ground;
  fall.height_limit = robot.height_limit * robot.standing_height;
  fall.low =
      model.contact_count() > 0 && robot.standing_height > 0.0 && fall.height < fall.height_limit;
  fall.upright = model.R_WB()[8];
  fall.tilt_limit = robot.tilt_limit;
  fall.tilted = fall.upright < std::cos(robot.tilt_limit);
  fall.touching = sensors.body_contact;
  return fall;
}

}  // namespace footfall::engine
