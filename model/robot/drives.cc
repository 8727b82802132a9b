// Reads actuators and torque loops of a robot file; see drives.h.
#include "model/robot/drives.h"

#include <fmt/format.h>

#include <limits>
#include <optional>

#include "core/yaml/glob.h"
#include "core/yaml/value_reader.h"
#include "model/robot/keys.h"
#include "model/robot/torque_loop.h"

namespace footfall::model {
namespace {

using core::Diagnostics;
using core::YamlNode;

std::optional<double> read_value(const YamlNode& value, const TorqueLoopKey& key,
                                 hal::TorqueLoopGains::Type type, Diagnostics& diagnostics) {
  return core::read_bounded(value, key.dimension(type), 0.0,
                            std::numeric_limits<double>::infinity(), diagnostics, key.noun(type));
}

// Type and damping of all joints' loops; nullopt: not a map.
std::optional<hal::TorqueLoopGains> read_law(const YamlNode& node, Diagnostics& diagnostics) {
  if (!core::expect_map(node, "{type: direct, p: NUMBER, d: DAMPING}", diagnostics)) return {};
  core::check_keys(node, kTorqueLoopKeys, diagnostics);
  hal::TorqueLoopGains all;
  if (const YamlNode* type = node.find("type")) {
    const auto choice = core::read_choice(*type, kTorqueLoopTypes, diagnostics);
    all.type = static_cast<hal::TorqueLoopGains::Type>(choice.value_or(0));
  }
  if (const YamlNode* damps = node.find("damps")) {
    const auto choice = core::read_choice(*damps, kTorqueLoopDampings, diagnostics);
    all.damps = static_cast<hal::TorqueLoopGains::Damping>(choice.value_or(0));
  }
  return all;
}

// A gain of all joints: one number, or a map by joint; joints without a value keep theirs.
void read_gain(const YamlNode& node, const TorqueLoopKey& key, RobotDescription& robot,
               Diagnostics& diagnostics) {
  std::vector<hal::TorqueLoopGains>& loops = robot.drives.torque_loop;
  const auto read = [&](const YamlNode& value, std::size_t joint) {
    hal::TorqueLoopGains& gains = loops[joint];
    const auto number = read_value(value, key, gains.type, diagnostics);
    gains.*key.member = number.value_or(gains.*key.member);
    return number.has_value();
  };
  if (!node.is_map()) {
    for (std::size_t j = 0; j < loops.size() && read(node, j); ++j) {
    }
    return;
  }
  std::vector<std::string> names;
  for (const JointDescription& joint : robot.joints) names.push_back(joint.name);
  const auto entries = core::match_names(node, names, "joint", diagnostics);
  for (std::size_t j = 0; j < entries.size(); ++j) {
    if (entries[j] != nullptr) read(entries[j]->value, j);
  }
}

}  // namespace

void read_positive(const YamlNode& map, std::string_view key, core::Dimension dimension,
                   double& out, Diagnostics& diagnostics) {
  constexpr double kTiny = 1e-9;
  const YamlNode* const node = map.find(key);
  if (node == nullptr) return;
  const auto value = core::read_quantity(*node, dimension, diagnostics);
  if (value && *value < kTiny) {
    diagnostics.error(node->mark, "out-of-range",
                      fmt::format("expected {} above zero, got {}", core::dimension_name(dimension),
                                  core::describe(*node)));
  } else if (value) {
    out = *value;
  }
}

void read_actuator(const YamlNode& sea, JointDescription& joint, Diagnostics& diagnostics) {
  if (!core::expect_map(sea, "{spring: STIFFNESS, rotor: INERTIA}", diagnostics)) return;
  core::check_keys(sea, kSeaKeys, diagnostics);
  // N m/rad: an angle has no dimension, so a stiffness is a torque here.
  core::require_key(sea, "spring", diagnostics);
  core::require_key(sea, "rotor", diagnostics);
  read_positive(sea, "spring", core::kTorque, joint.spring, diagnostics);
  read_positive(sea, "rotor", core::kInertia, joint.rotor, diagnostics);
  read_positive(sea, "torque", core::kTorque, joint.motor_torque, diagnostics);
  read_positive(sea, "speed", core::kRate, joint.motor_speed, diagnostics);
}

void read_torque_loop(const YamlNode& node, RobotDescription& robot, Diagnostics& diagnostics) {
  const auto law = read_law(node, diagnostics);
  if (!law) return;
  robot.drives.torque_loop.assign(robot.joints.size(), *law);
  for (const TorqueLoopKey& key : kTorqueLoopGainKeys) {
    if (const YamlNode* value = node.find(key.name)) read_gain(*value, key, robot, diagnostics);
  }
}

void check_torque_loop(const YamlNode& node, Diagnostics& diagnostics) {
  const auto law = read_law(node, diagnostics);
  if (!law) return;
  for (const TorqueLoopKey& key : kTorqueLoopGainKeys) {
    const YamlNode* const value = node.find(key.name);
    if (value == nullptr) continue;
    if (!value->is_map()) read_value(*value, key, law->type, diagnostics);
    for (const core::YamlEntry& entry : value->entries) {
      read_value(entry.value, key, law->type, diagnostics);
    }
  }
}

void read_drives(const YamlNode& node, RobotDescription& robot, Diagnostics& diagnostics) {
  DriveDescription& drives = robot.drives;
  drives.mark = node.mark;
  drives.file = diagnostics.file(node.mark.file);
  if (!core::expect_map(node, "{torque_loop: {...}}", diagnostics)) return;
  core::check_keys(node, kDrivesKeys, diagnostics);
  constexpr double kFastest = 1e6;  // Hz
  if (const YamlNode* rate = node.find("rate")) {
    drives.rate = core::read_bounded(*rate, core::kRate, 1.0, kFastest, diagnostics,
                                     "a rate of 1 Hz to 1 MHz")
                      .value_or(drives.rate);
  }
  read_positive(node, "motor_filter", core::kRate, drives.filters.motor, diagnostics);
  read_positive(node, "spring_filter", core::kRate, drives.filters.spring, diagnostics);
  if (const YamlNode* loop = core::require_key(node, "torque_loop", diagnostics)) {
    read_torque_loop(*loop, robot, diagnostics);
  }
}

}  // namespace footfall::model
