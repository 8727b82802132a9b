// Values of a world's file by joint, whose names only a robot knows: kept as written, checked at
// once as far as possible, read when the robot is there. Load time only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/yaml/yaml.h"
#include "model/robot/description.h"

namespace footfall::sim {

// An angle within half a radian: `axis_tilts`.
std::optional<double> read_tilt(const core::YamlNode& node, core::Diagnostics& diagnostics);

// An angle within a turn: `start: {joints}`.
std::optional<double> read_turn(const core::YamlNode& node, core::Diagnostics& diagnostics);

using ReadValue = std::optional<double> (*)(const core::YamlNode&, core::Diagnostics&);

struct ByJoint {
  core::YamlNode node;  // one value for all joints, or a map by joint (globs); null: none
  std::string file;     // of its positions
};

// The node at positions of these diagnostics, which may not know its file yet.
core::YamlNode placed(const ByJoint& given, core::Diagnostics& diagnostics);
void check_by_joint(const core::YamlNode& node, ReadValue read, const char* expected,
                    core::Diagnostics& diagnostics);
// By joint of the robot, 0 where none is given. Reports joints that it does not have.
std::vector<double> by_joint(const ByJoint& given, ReadValue read,
                             const model::RobotDescription& robot, core::Diagnostics& diagnostics);

}  // namespace footfall::sim
