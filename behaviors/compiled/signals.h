// Names, units and indices of all signals of a robot and a behavior. Used by the loader to compile
// expressions, by the engine in every tick, by the log and the report.
#pragma once

#include <string>
#include <vector>

#include "core/signal_table.h"
#include "core/units/units.h"
#include "model/robot/description.h"

namespace footfall::behaviors {

// Indices of the rows of one task: task.NAME.*
struct TaskSignals {
  // Norm of the error over its axes; of mixed lengths and angles (frame_pose) only over the
  // lengths.
  int error = -1;
  std::vector<bool> in_norm;  // by axis
  int axis_count = 0;
  std::vector<int> axis_error;      // task.NAME.error.AXIS
  std::vector<int> axis_reference;  // task.NAME.reference.AXIS
  std::vector<int> axis_measured;   // task.NAME.measured.AXIS
  std::vector<int> axis_commanded;  // task.NAME.commanded.AXIS (acceleration)
  std::vector<int> axis_achieved;   // task.NAME.achieved.AXIS (acceleration, by the control model)
  int rank = -1;                    // rank of its level
  int condition = -1;               // condition estimate of its level
  int authority = -1;               // feasible part of the commanded accelerations: 1 all, 0 none
};

struct InternalSignals {
  int reference = -1;  // N
  int measured = -1;   // N
};

struct PlannerSignals {
  int target = -1;         // x; y and z follow (planner.NAME.target.x/y/z), m, world
  int predicted_pos = -1;  // x, y: CoM at the switch as predicted, m, world
  int predicted_vel = -1;  // x, y: CoM velocity at the switch as predicted, m/s, world
  int switch_time = -1;    // absolute time of the predicted switch, s
  int late = -1;
  int extension = -1;  // s, landing delay requested by the swing-time rule
};

// A task name of a behavior and the axes that it may have.
struct TaskName {
  std::string name;
  std::vector<std::string> axes;
  std::vector<core::Dimension> dimensions;  // of the axes
  bool is_rate = false;  // what is measured is a rate: what is commanded is its first derivative
};

// What the estimator thinks of itself; xyz members are the index of x.
struct EstimateSignals {
  int gyro_bias = -1;             // estimate.gyro_bias.{x,y,z}, rad/s, IMU frame; -1: none of them
  int accelerometer_bias = -1;    // estimate.accelerometer_bias.{x,y,z}, m/s^2, IMU frame
  int attitude = -1;              // estimate.sigma.{roll,pitch,yaw}, rad
  int position = -1;              // estimate.sigma.position.{x,y,z}, m, world
  int velocity = -1;              // estimate.sigma.velocity.{x,y,z}, m/s, world
  int markers = -1;               // estimate.markers: used of the last frame
  int marker_innovation = -1;     // estimate.innovation.marker, m
  int kinematic_innovation = -1;  // estimate.innovation.kinematic
};

// What a simulator knows beside the sensors, else NaN; index of x.
struct TruthSignals {
  int com_pos = -1;             // truth.com.pos.{x,y,z}, m, world; -1: none of them
  int base_pos = -1;            // truth.base.pos.{x,y,z}, m, world
  int base_vel = -1;            // truth.base.vel.{x,y,z}, m/s, world
  int base_rpy = -1;            // truth.base.rpy.{roll,pitch,yaw}, rad
  int gyro_bias = -1;           // truth.gyro_bias.{x,y,z}, rad/s, IMU frame
  int accelerometer_bias = -1;  // truth.accelerometer_bias.{x,y,z}, m/s^2, IMU frame
};

// Layout of the table. All `xyz` members are the index of x; y and z follow.
struct SignalLayout {
  int time = -1;                 // s since start
  int com_pos = -1;              // com.pos.{x,y,z}, m, world
  int com_vel = -1;              // com.vel.{x,y,z}
  int com_ref = -1;              // com.ref.{x,y,z}: references of com_position tasks, else actual
  int base_pos = -1;             // base.pos.{x,y,z}
  int base_vel = -1;             // base.vel.{x,y,z}
  int base_rpy = -1;             // base.rpy.{roll,pitch,yaw}, rad
  int base_angvel = -1;          // base.angvel.{x,y,z}, rad/s, base frame
  int centroidal_momentum = -1;  // centroidal.{linear.x..z, angular.x..z}
  std::vector<int> contact;      // contact.NAME: 1 while the switch is closed
  std::vector<int> support;      // support.NAME: 1 while in the contact set of the control law
  std::vector<int> force;        // force.NAME.{x,y,z}: measured, ground on robot, N, world
  std::vector<int> force_cmd;    // force_cmd.NAME.{x,y,z}: predicted by the control law
  std::vector<int> force_est;    // force_est.NAME.{x,y,z}: by the measured joint torques
  std::vector<int> point;        // point.NAME.{x,y,z}: contacts first, then points; m, world
  std::vector<int> joint;        // joint.NAME.{position,velocity,torque,command,motor}
  std::vector<TaskSignals> task;
  std::vector<InternalSignals> internal;
  std::vector<PlannerSignals> planner;
  int steps = -1;              // steps counted by the behavior's marks
  int state = -1;              // index of the first active atomic state in document order
  int transition_weight = -1;  // of the second control law, 0..1
  int motor_saturated = -1;    // 0 or 1
  int aid_force = -1;          // aid.force.{x,y,z}: of external aids on the robot, N, world
  int torque_step = -1;        // largest |tau - tau_previous| over joints, N m
  int faults = -1;             // faults counted so far
  int tick_late = -1;          // ticks so far that began late
  int goal = -1;               // goal.{x,y}: target position, m
  EstimateSignals estimate;    // none with the true state
  TruthSignals truth;          // likewise
};

// Registers all signals in a deterministic order. `estimated`: with those of an estimator.
SignalLayout register_signals(const model::RobotDescription& robot,
                              const std::vector<TaskName>& tasks,
                              const std::vector<std::string>& internals,
                              const std::vector<std::string>& planners, core::SignalTable& table,
                              bool estimated = false);

}  // namespace footfall::behaviors
