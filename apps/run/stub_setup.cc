// Settings of the stub; see stub_setup.h.
#include "apps/run/stub_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace footfall::apps {

sim::WorldDescription stand_world(sim::WorldDescription world,
                                  const model::RobotDescription& robot) {
  const bool rigid =
      robot.drives.torque_loop.empty() &&
      std::ranges::all_of(robot.joints, [](const auto& joint) { return joint.spring == 0.0; });
  if (rigid) world.actuators.model = sim::ActuatorModel::ideal;
  return world;
}

int stand_steps(const sim::WorldDescription& world, const model::RobotDescription& robot) {
  if (world.actuators.model == sim::ActuatorModel::ideal) return 1;
  return std::max(1, static_cast<int>(std::lround(robot.drives.rate / robot.rate_hz())));
}

hal::StubSettings stub_settings(const model::RobotDescription& robot,
                                const sim::WorldDescription& world) {
  hal::StubSettings settings;
  settings.joints = robot.joint_count();
  settings.contacts = static_cast<int>(robot.contacts.size());
  settings.period = robot.period_s();
  settings.base = {0.0, 0.0, robot.standing_height};
  core::Diagnostics ignored;  // the world was checked
  const std::vector<double> beside = sim::start_joints(world.start_joints, robot, ignored);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const double drawn = j < world.start.joints.size() ? world.start.joints[j] : 0.0;
    settings.start.push_back(robot.joints[j].posture + beside[j] + drawn);
  }
  settings.inertia = world.stand.inertia;
  settings.stiffness = world.stand.stiffness;
  settings.damping = world.stand.damping;
  settings.swing = world.stand.swing;
  settings.sensors = world.sensors.errors;
  const bool mounted = !robot.sensors.imu_site.empty() || !robot.sensors.mocap_sites.empty();
  settings.places =
      sim::sensor_places(mounted ? model::sensor_mounts(robot) : model::SensorMounts(), robot);
  settings.noise_seed = world.noise_seed;
  settings.drive_steps = stand_steps(world, robot);
  if (world.actuators.model == sim::ActuatorModel::series_elastic) {
    settings.drive = sim::drive_settings(world.actuators, robot, settings.drive_steps);
  } else {
    settings.command_delay =
        static_cast<int>(std::lround(world.actuators.command_delay * robot.rate_hz()));
  }
  return settings;
}

std::string stub_facts(const sim::WorldDescription& world) {
  const sim::StandSettings& stand = world.stand;
  const bool elastic = world.actuators.model == sim::ActuatorModel::series_elastic;
  return fmt::format(
      "a stand: joints {:g} kg m^2, {:g} Nm/rad, {:g} Nm s/rad; {} actuators; feet touch "
      "down {:g} ms after their release",
      stand.inertia, stand.stiffness, stand.damping, elastic ? "series-elastic" : "ideal",
      1e3 * stand.swing);
}

}  // namespace footfall::apps
