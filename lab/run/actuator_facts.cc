// Torque loops of a behavior's laws; see actuator_facts.h.
#include "lab/run/actuator_facts.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "behaviors/compiled/torque_loops.h"
#include "core/index.h"
#include "hal/actuators/passivity.h"

namespace footfall::lab {

nlohmann::ordered_json actuator_facts(const behaviors::Behavior& behavior) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const model::RobotDescription& robot = behavior.robot;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const model::JointDescription& joint = robot.joints[at(j)];
    if (joint.spring <= 0.0) continue;
    std::set<int> tables;  // -1: the robot's own
    for (const behaviors::ControlSpec& control : behavior.controls) {
      tables.insert(control.torque_loops.empty() ? -1 : control.torque_loops[at(j)]);
    }
    const hal::SeriesElasticParameters actuator{.spring = joint.spring, .rotor = joint.rotor};
    for (const int table : tables) {
      const auto gains = behaviors::torque_loop_gains(behavior, table, j, behavior.values);
      const bool cascade = gains.type == hal::TorqueLoopGains::Type::cascade;
      const auto rounded = [](double value) { return std::round(1e4 * value) / 1e4; };
      list.push_back({{"joint", joint.name},
                      {"table", table < 0 ? "drives" : behavior.torque_loops[at(table)].name},
                      {"type", cascade ? "cascade" : "direct"},
                      {"bandwidth_Hz", rounded(hal::loop_bandwidth(gains, actuator))},
                      {"passivity_margin", rounded(hal::passivity_margin(gains, actuator))}});
    }
  }
  return list;
}

}  // namespace footfall::lab
