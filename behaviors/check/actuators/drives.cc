// Stability of a robot's own torque loops; see drives.h.
#include "behaviors/check/actuators/drives.h"

#include <fmt/format.h>

#include "behaviors/check/actuators/sampled_torque_loop.h"

namespace footfall::behaviors {

void check_drives(const model::RobotDescription& robot, core::Diagnostics& diagnostics) {
  constexpr double kRounding = 1e-9;
  const model::DriveDescription& drives = robot.drives;
  for (std::size_t j = 0; j < drives.torque_loop.size(); ++j) {
    const model::JointDescription& joint = robot.joints[j];
    if (joint.spring <= 0.0 || joint.rotor <= 0.0) continue;
    const double growth =
        torque_loop_growth(drives.torque_loop[j], {.spring = joint.spring, .rotor = joint.rotor},
                           1.0 / drives.rate, drives.filters);
    if (growth <= 1.0 + kRounding) continue;
    core::Mark mark = drives.mark;
    mark.file = diagnostics.add_file(robot.path);
    diagnostics.error(mark, "unstable-torque-loop",
                      fmt::format("the torque loop of '{}' is unstable: with its output locked an "
                                  "error grows {:.4g} times in each step of {:g} Hz; expected less "
                                  "gain, more damping, or a higher rate or filter",
                                  joint.name, growth, drives.rate));
    return;
  }
}

}  // namespace footfall::behaviors
