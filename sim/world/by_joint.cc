// Maps by joint; see by_joint.h.
#include "sim/world/by_joint.h"

#include "core/yaml/glob.h"
#include "core/yaml/value_reader.h"

namespace footfall::sim {
namespace {

// Positions in a file that these diagnostics may not know yet.
void move_to(core::YamlNode& node, int file) {
  node.mark.file = file;
  for (core::YamlEntry& entry : node.entries) {
    entry.key_mark.file = file;
    move_to(entry.value, file);
  }
}

}  // namespace

core::YamlNode placed(const ByJoint& given, core::Diagnostics& diagnostics) {
  core::YamlNode node = given.node;
  move_to(node, diagnostics.add_file(given.file));
  return node;
}

void check_by_joint(const core::YamlNode& node, ReadValue read, const char* expected,
                    core::Diagnostics& diagnostics) {
  if (node.is_scalar()) {
    read(node, diagnostics);
  } else if (core::expect_map(node, expected, diagnostics)) {
    for (const core::YamlEntry& entry : node.entries) read(entry.value, diagnostics);
  }
}

std::vector<double> by_joint(const ByJoint& given, ReadValue read,
                             const model::RobotDescription& robot, core::Diagnostics& diagnostics) {
  std::vector<double> values(robot.joints.size(), 0.0);
  if (given.node.is_null()) return values;
  const core::YamlNode node = placed(given, diagnostics);
  if (node.is_scalar()) {
    if (!node.scalar.empty()) values.assign(values.size(), read(node, diagnostics).value_or(0.0));
    return values;
  }
  std::vector<std::string> names;
  for (const model::JointDescription& joint : robot.joints) names.push_back(joint.name);
  const auto entries = core::match_names(node, names, "joint", diagnostics);
  for (std::size_t j = 0; j < entries.size(); ++j) {
    if (entries[j] != nullptr) values[j] = read(entries[j]->value, diagnostics).value_or(0.0);
  }
  return values;
}

}  // namespace footfall::sim
