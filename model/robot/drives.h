// The actuators of a robot file: `sea:` of a joint, and `drives:`. Load time only.
#pragma once

#include <string_view>

#include "core/units/units.h"
#include "core/yaml/yaml.h"
#include "model/robot/description.h"

namespace footfall::model {

// A value above zero, if the key is there.
void read_positive(const core::YamlNode& map, std::string_view key, core::Dimension dimension,
                   double& out, core::Diagnostics& diagnostics);

void read_actuator(const core::YamlNode& sea, JointDescription& joint,
                   core::Diagnostics& diagnostics);
// `torque_loop:` in the place of the robot's; a world may have one, too. Needs the robot's joints.
void read_torque_loop(const core::YamlNode& node, RobotDescription& robot,
                      core::Diagnostics& diagnostics);
// What of it can be judged without a robot: all but the names of joints.
void check_torque_loop(const core::YamlNode& node, core::Diagnostics& diagnostics);
// Needs the robot's joints.
void read_drives(const core::YamlNode& node, RobotDescription& robot,
                 core::Diagnostics& diagnostics);

}  // namespace footfall::model
