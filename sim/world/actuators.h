// `actuators:` of a world file: dynamics between the tick's command and the joint torque. Load time
// only; backends build their drives from it.
#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/yaml/yaml.h"
#include "hal/actuators/drive.h"
#include "model/robot/description.h"
#include "sim/world/by_joint.h"

namespace footfall::sim {

enum class ActuatorModel { ideal, series_elastic };

// Imperfections; 0 is perfect. All but command_delay need `model: series_elastic`.
struct ActuatorSettings {
  ActuatorModel model = ActuatorModel::ideal;
  double command_delay = 0.0;          // s, from the tick's write to the torque (loop)
  double measurement_delay = 0.0;      // s, from the encoders to the tick's read
  double viscous = 0.0;                // N m s/rad, of every rotor
  double coulomb = 0.0;                // N m, of every rotor
  double motor_resolution = 0.0;       // rad, of the motors' encoders
  double deflection_resolution = 0.0;  // rad, of the springs' encoders
  ByJoint spring;                      // relative change of the true springs
  ByJoint flexible;                    // N m/rad, stiffness of links
  double command_limit = 1.0;          // of commands, over the joints' limits of torque
  ByJoint stiffness;                   // N m/rad, of springs and drives in the place of the robot's
  ByJoint torque_loop;                 // gains of the drives in the place of the robot's: their map
  core::Mark mark;                     // position of `model`, else of the section
  std::string file;                    // of that position
  struct Key {
    std::string name;
    core::Mark mark;
  };
  std::vector<Key> elastic_keys;  // those written that need series_elastic
  // As drawn, by joint; empty: not drawn.
  std::vector<double> drawn_springs;  // factors
  std::vector<double> drawn_coulomb;  // factors
};

// Whether the world has actuators other than the robot's file.
bool changes_robot(const ActuatorSettings& actuators);
// Makes the robot's springs and torque loops those of the world. Everything that uses them (the
// behavior's tables, the checks, the drives) has the robot from here.
void apply_actuators(const ActuatorSettings& actuators, model::RobotDescription& robot,
                     core::Diagnostics& diagnostics);

void read_actuators(const core::YamlNode& node, ActuatorSettings& actuators,
                    core::Diagnostics& diagnostics);

// What a robot lacks that the actuators need, and what cannot be simulated with its drives: at the
// places in the world's file.
void check_actuators(const ActuatorSettings& actuators, const model::RobotDescription& robot,
                     int steps_per_tick, core::Diagnostics& diagnostics);

// The drive of a robot whose plant takes `plant_steps` steps a tick: advance() is one of them.
// Throws std::runtime_error for what check_actuators() reports.
hal::DriveSettings drive_settings(const ActuatorSettings& actuators,
                                  const model::RobotDescription& robot, int plant_steps);

}  // namespace footfall::sim
