// Has the robot fallen? Judged from one tick's sensors and state; no memory, no clock. Where the
// state is estimated and a simulator knows the truth, the worse of the two decides: an estimate
// does not hide a fall, and a robot acts on its estimate.
#pragma once

#include <algorithm>
#include <cmath>

#include "hal/hardware.h"
#include "model/control_model.h"
#include "model/robot/description.h"

namespace footfall::engine {

// The criteria of a fall that a tick can measure. Source: docs/architecture.md, how we count.
struct FallCriteria {
  double height = 0.0, height_limit = 0.0;  // m, of the base above the lowest contact point
  double upright = 1.0, tilt_limit = 0.0;   // cosine of the tilt; rad, from upright
  bool low = false, tilted = false, touching = false;  // touching: a body that is no foot
  double tilt() const noexcept { return std::acos(std::clamp(upright, -1.0, 1.0)); }  // rad
  bool fallen() const noexcept { return low || tilted || touching; }
};
FallCriteria judge_fall(const model::RobotDescription& robot, const hal::Sensors& sensors,
                        const model::ControlModel& model) noexcept;

}  // namespace footfall::engine
