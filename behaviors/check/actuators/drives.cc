// Stability of a robot's own torque loops; see drives.h.
#include "behaviors/check/actuators/drives.h"

#include <fmt/format.h>

#include <cmath>

#include "behaviors/check/actuators/sampled_torque_loop.h"

namespace footfall::behaviors {

namespace {

// Empty: none.
std::string problem_of(const hal::TorqueLoopGains& gains, const model::JointDescription& joint,
                       const model::DriveDescription& drives) {
  constexpr double kRounding = 1e-9;
  if (hal::gives_no_torque(gains)) {
    return "gives no torque: expected p (and velocity_p of a cascade) above 0";
  }
  const double period = 1.0 / drives.rate;
  const double growth = torque_loop_growth(gains, {.spring = joint.spring, .rotor = joint.rotor},
                                           period, drives.filters);
  if (growth <= 1.0 + kRounding) return {};
  const std::string grows = growth > 1.1
                                ? fmt::format("{:.3g} times in each step", growth)
                                : fmt::format("by e in {:.3g} s", period / std::log(growth));
  return fmt::format(
      "is unstable: with its output locked an error grows {} at {:g} Hz; expected "
      "less gain, more damping, or a higher rate or filter",
      grows, drives.rate);
}

}  // namespace

void check_drives(const model::RobotDescription& robot, core::Diagnostics& diagnostics) {
  const model::DriveDescription& drives = robot.drives;
  for (std::size_t j = 0; j < drives.torque_loop.size(); ++j) {
    const model::JointDescription& joint = robot.joints[j];
    if (joint.spring <= 0.0 || joint.rotor <= 0.0) continue;
    const auto& gains = drives.torque_loop[j];
    const std::string problem = problem_of(gains, joint, drives);
    if (problem.empty()) continue;
    core::Mark mark = drives.mark;
    mark.file = diagnostics.add_file(drives.file);
    diagnostics.error(mark, "torque-loop",
                      fmt::format("the torque loop of '{}' {}", joint.name, problem));
    return;
  }
}

}  // namespace footfall::behaviors
