// `sensors:` of a world file: how far the robot's sensors are from perfect. Load time only;
// backends build their sensors from it.
#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/yaml/yaml.h"
#include "hal/sensors/errors.h"
#include "model/robot/description.h"
#include "model/sensor_mounts.h"

namespace footfall::sim {

struct SensorSettings {
  hal::SensorErrors errors;
  // Every value that was written, by dotted name ("gyro.noise").
  struct Key {
    std::string name;
    std::string file;
    core::Mark mark;  // in that file
  };
  std::vector<Key> keys;
};

void read_sensors(const core::YamlNode& node, SensorSettings& sensors,
                  core::Diagnostics& diagnostics);

// Errors of sensors that a robot lacks (id "no-sensor"), at their places in the world's file.
void check_sensors(const SensorSettings& sensors, const model::RobotDescription& robot,
                   core::Diagnostics& diagnostics);

// Where the robot's sensors are.
hal::SensorPlaces sensor_places(const model::SensorMounts& mounts,
                                const model::RobotDescription& robot);

}  // namespace footfall::sim
