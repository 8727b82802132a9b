// Reading, checking and building of drives; see actuators.h.
#include "sim/world/actuators.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/yaml/value_reader.h"
#include "model/robot/drives.h"
#include "sim/world/by_joint.h"
#include "sim/world/keys.h"

namespace footfall::sim {
namespace {

using core::Diagnostics;
using core::YamlNode;

constexpr double kLongestDelay = 0.02;  // s; the checks of gains take the delay in ticks
constexpr std::array<double, 2> kSpringChange = {-0.9, 9.0};

std::optional<double> read_change(const YamlNode& node, Diagnostics& diagnostics) {
  return core::read_bounded(node, core::kNone, kSpringChange[0], kSpringChange[1], diagnostics,
                            "a change such as \"+3 %\"");
}

std::optional<double> read_stiffness(const YamlNode& node, Diagnostics& diagnostics) {
  return core::read_bounded(node, core::kTorque, 1.0, std::numeric_limits<double>::infinity(),
                            diagnostics, "a stiffness of at least 1 Nm/rad");
}

// Factors of the springs, by joint: the world's times what was drawn.
std::vector<double> spring_factors(const ActuatorSettings& actuators,
                                   const model::RobotDescription& robot, Diagnostics& diagnostics) {
  std::vector<double> factors = by_joint(actuators.spring, read_change, robot, diagnostics);
  for (std::size_t j = 0; j < factors.size(); ++j) {
    factors[j] += 1.0;
    if (j < actuators.drawn_springs.size()) factors[j] *= actuators.drawn_springs[j];
  }
  return factors;
}

// Steps of the torque loops in a plant's step; 0 if they are no whole number.
int steps_of(const model::RobotDescription& robot, int plant_steps) {
  const double plant_rate = robot.rate_hz() * plant_steps;
  const double steps = robot.drives.rate / plant_rate;
  const double whole = std::round(steps);
  return whole >= 1.0 && std::abs(steps - whole) < 1e-6 * whole ? static_cast<int>(whole) : 0;
}

}  // namespace

void read_actuators(const YamlNode& node, ActuatorSettings& actuators, Diagnostics& diagnostics) {
  actuators.mark = node.mark;
  actuators.file = diagnostics.file(node.mark.file);
  if (!core::expect_map(node, "{model: ideal}", diagnostics)) return;
  core::check_keys(node, kActuatorsKeys, diagnostics);
  if (const YamlNode* model = node.find("model")) {
    actuators.mark = model->mark;
    actuators.file = diagnostics.file(model->mark.file);
    const auto choice =
        core::read_choice(*model, kActuatorModels, diagnostics, "an actuator model");
    if (choice) actuators.model = static_cast<ActuatorModel>(*choice);
  }
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const auto read = [&](const char* key, core::Dimension dimension, double most, double& out,
                        std::string_view what = {}) {
    const YamlNode* const value = node.find(key);
    if (value == nullptr) return;
    out = core::read_bounded(*value, dimension, 0.0, most, diagnostics, what).value_or(out);
    if (&out != &actuators.command_delay) actuators.elastic_keys.push_back({key, value->mark});
  };
  read("command_delay", core::kTime, kLongestDelay, actuators.command_delay);
  read("measurement_delay", core::kTime, kLongestDelay, actuators.measurement_delay);
  constexpr double kMostViscous = 1e4;  // N m s/rad: with more, round-off moves a locked rotor
  read("viscous", core::kAngularMomentum, kMostViscous, actuators.viscous, "a damping");
  read("coulomb", core::kTorque, kAny, actuators.coulomb);
  read("motor_resolution", core::kNone, 1.0, actuators.motor_resolution, "an angle");
  read("deflection_resolution", core::kNone, 1.0, actuators.deflection_resolution, "an angle");
  const auto keep = [&](const char* key, ReadValue read_one, const char* expected, ByJoint& out) {
    const YamlNode* const value = node.find(key);
    if (value == nullptr) return;
    out = {*value, diagnostics.file(value->mark.file)};
    actuators.elastic_keys.push_back({key, value->mark});
    check_by_joint(*value, read_one, expected, diagnostics);
  };
  keep("stiffness", read_stiffness, "a stiffness, or one by joint", actuators.stiffness);
  if (const YamlNode* loop = node.find("torque_loop")) {
    actuators.torque_loop = {*loop, diagnostics.file(loop->mark.file)};
    actuators.elastic_keys.push_back({"torque_loop", loop->mark});
    model::check_torque_loop(*loop, diagnostics);
  }
  if (const YamlNode* const limit = node.find("command_limit")) {
    actuators.command_limit =
        core::read_bounded(*limit, core::kNone, 1.0, 10.0, diagnostics, "100 % to 1000 %")
            .value_or(actuators.command_limit);
    actuators.elastic_keys.push_back({"command_limit", limit->mark});
  }
  keep("spring", read_change, "a change such as \"+3 %\", or one by joint", actuators.spring);
  keep("flexible", read_stiffness, "a stiffness, or one by joint", actuators.flexible);
}

bool changes_robot(const ActuatorSettings& actuators) {
  return actuators.model == ActuatorModel::series_elastic &&
         !(actuators.stiffness.node.is_null() && actuators.torque_loop.node.is_null() &&
           actuators.command_limit == 1.0);
}

void apply_actuators(const ActuatorSettings& actuators, model::RobotDescription& robot,
                     Diagnostics& diagnostics) {
  if (!changes_robot(actuators)) return;
  robot.command_limit = actuators.command_limit;
  const std::vector<double> springs =
      by_joint(actuators.stiffness, read_stiffness, robot, diagnostics);
  for (std::size_t j = 0; j < springs.size(); ++j) {
    if (springs[j] > 0.0) robot.joints[j].spring = springs[j];
  }
  if (actuators.torque_loop.node.is_null()) return;
  const YamlNode loop = placed(actuators.torque_loop, diagnostics);
  model::read_torque_loop(loop, robot, diagnostics);
  robot.drives.mark = loop.mark;
  robot.drives.file = actuators.torque_loop.file;
}

void check_actuators(const ActuatorSettings& actuators, const model::RobotDescription& robot,
                     int steps_per_tick, Diagnostics& diagnostics) {
  if (actuators.model == ActuatorModel::ideal) return;
  core::Mark mark = actuators.mark;
  mark.file = diagnostics.add_file(actuators.file);
  for (const model::JointDescription& joint : robot.joints) {
    if (joint.spring > 0.0 && joint.rotor > 0.0) continue;
    diagnostics.error(
        mark, "actuators",
        fmt::format("series-elastic actuators need 'sea: {{spring: ..., rotor: ...}}' "
                    "of every joint: robot '{}' has none at '{}'",
                    robot.name, joint.name));
    return;
  }
  if (robot.drives.torque_loop.empty()) {
    diagnostics.error(
        mark, "actuators",
        fmt::format("series-elastic actuators need gains of their torque loops: robot "
                    "'{}' has no 'drives: {{torque_loop: ...}}'",
                    robot.name));
  }
  if (steps_of(robot, steps_per_tick) == 0) {
    diagnostics.error(
        mark, "actuators",
        fmt::format("the torque loops run at {:g} Hz ('drives: {{rate: ...}}' of robot '{}'), the "
                    "physics at {:g} Hz: expected a whole multiple",
                    robot.drives.rate, robot.name, robot.rate_hz() * steps_per_tick));
  }
  spring_factors(actuators, robot, diagnostics);
  by_joint(actuators.flexible, read_stiffness, robot, diagnostics);
}

hal::DriveSettings drive_settings(const ActuatorSettings& actuators,
                                  const model::RobotDescription& robot, int plant_steps) {
  Diagnostics problems;
  check_actuators(actuators, robot, plant_steps, problems);
  if (problems.has_errors()) throw std::runtime_error(problems.all().front().text);
  const std::vector<double> factors = spring_factors(actuators, robot, problems);
  const std::vector<double> links = by_joint(actuators.flexible, read_stiffness, robot, problems);
  hal::DriveSettings settings;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const model::JointDescription& joint = robot.joints[j];
    const double factor = j < actuators.drawn_coulomb.size() ? actuators.drawn_coulomb[j] : 1.0;
    settings.joints.push_back({{.spring = joint.spring * factors[j],
                                .rotor = joint.rotor,
                                .viscous = actuators.viscous,
                                .coulomb = factor * actuators.coulomb,
                                .torque = joint.motor_torque,
                                .speed = joint.motor_speed},
                               joint.spring,
                               robot.drives.torque_loop[j],
                               links[j]});
  }
  settings.steps = steps_of(robot, plant_steps);
  settings.step = 1.0 / robot.drives.rate;
  const auto steps = [&](double delay) {
    return static_cast<int>(std::lround(delay / settings.step));
  };
  settings.command_delay = steps(actuators.command_delay);
  settings.measurement_delay = steps(actuators.measurement_delay);
  settings.motor_resolution = actuators.motor_resolution;
  settings.deflection_resolution = actuators.deflection_resolution;
  settings.filters = robot.drives.filters;
  return settings;
}

}  // namespace footfall::sim
