// Names, units and places of every signal of a robot and a behavior. The loader compiles
// expressions against it, the engine fills it every tick, the log and the report read it.
#pragma once

#include <string>
#include <vector>

#include "core/signal_table.h"
#include "core/units/units.h"
#include "model/robot/description.h"

namespace footfall::behaviors {

// Indices of the rows of one task: task.NAME.*
struct TaskSignals {
  // Norm of the error over its axes; where lengths and angles meet (frame_pose), over the lengths.
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
  int authority = -1;               // 1: all commanded axes can be met, 0: none
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
  int extension = -1;  // s, by which the swing-time rule wants landing prolonged
};

// A task as named by a behavior: name and the axes it may have.
struct TaskName {
  std::string name;
  std::vector<std::string> axes;
  std::vector<core::Dimension> dimensions;  // of the axes
  bool is_rate = false;  // what is measured is a rate: what is commanded is its first derivative
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
  std::vector<int> support;      // support.NAME: 1 while the control law counts on it
  std::vector<int> force;        // force.NAME.{x,y,z}: measured, ground on robot, N, world
  std::vector<int> force_cmd;    // force_cmd.NAME.{x,y,z}: as the control law predicts it
  std::vector<int> point;        // point.NAME.{x,y,z}: contacts first, then points; m, world
  std::vector<int> joint;        // joint.NAME.{position,velocity,torque,command}: 4 in a row
  std::vector<TaskSignals> task;
  std::vector<InternalSignals> internal;
  std::vector<PlannerSignals> planner;
  int steps = -1;              // steps marked by the behavior
  int state = -1;              // index of the first active atomic state in document order
  int transition_weight = -1;  // of the other control law, 0..1
  int torque_step = -1;        // largest |tau - tau_previous| over joints, N m
  int faults = -1;             // faults counted so far
  int tick_late = -1;          // periods skipped so far because a tick came too late
  int goal = -1;               // goal.{x,y}: where it was told to stay, m
};

// Registers everything; deterministic order.
SignalLayout register_signals(const model::RobotDescription& robot,
                              const std::vector<TaskName>& tasks,
                              const std::vector<std::string>& internals,
                              const std::vector<std::string>& planners, core::SignalTable& table);

}  // namespace footfall::behaviors
