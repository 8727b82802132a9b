// What the state machine asks of the whole-body controller in this tick: plain numbers only.
// Written by behaviors/ every tick, read by tasks/solver/wbosc. Capacities are fixed.
#pragma once

#include <array>
#include <cstdint>

#include "core/limits.h"

namespace footfall::tasks {

enum class TaskType : std::uint8_t {
  com_position,       // axes x y z = 0 1 2, m
  body_orientation,   // axes roll pitch yaw = 0 1 2 of the floating base, rad
  point_position,     // axes x y z = 0 1 2 of a contact point or named point, m
  joint_posture,      // axes = joint indices, rad
  joint_damping,      // axes = joint indices, reference velocity 0
  frame_orientation,  // axes roll pitch yaw = 0 1 2 of a named point's frame, rad
  frame_pose,         // axes x y z roll pitch yaw = 0 .. 5 of a named point's frame, m and rad
  centroidal_angular_momentum,  // axes x y z = 0 1 2 about the CoM, kg m^2/s
};

// How many axes a task of this type may have.
constexpr int axis_capacity(TaskType type, int joints) noexcept {
  const bool of_joints = type == TaskType::joint_posture || type == TaskType::joint_damping;
  return of_joints ? joints : type == TaskType::frame_pose ? 6 : 3;
}

// What a task's quantity is measured against. Directions are the world's except for `heading`.
enum class Frame : std::uint8_t {
  usual,  // orientations: heading; all else: world
  world,
  stance,   // positions: from the mean of the contact points in force
  heading,  // orientations, momentum: z up, x where the torso (or the frame itself) points
};

// One controlled axis of a task in this tick.
struct AxisCommand {
  int axis = 0;          // x y z / roll pitch yaw as TaskType says, or the joint's index
  double kp = 0.0;       // 1/s^2
  double ki = 0.0;       // 1/s^3
  double kd = 0.0;       // 1/s
  double ref = 0.0;      // position reference, m or rad
  double ref_vel = 0.0;  // feed-forward velocity
  double ref_acc = 0.0;  // feed-forward acceleration
  double weight = 1.0;   // inside a level, matters only where the level is over-determined
  double acceleration_limit = 0.0;  // m/s^2 or rad/s^2 on what is commanded; 0: none
  double integral_limit = 0.0;      // clamp of |integral of error|; 0: none
  double slope = 0.0;  // positions: the axis is p - slope x, so that a height follows a surface
  bool fresh = false;  // in force since this tick: its integral starts at 0
};

struct TaskCommand {
  int instance = 0;  // identity for integral, logs: index into Behavior::task_instances
  TaskType type = TaskType::com_position;
  int point = -1;  // index into the control model's points, for point and frame tasks
  Frame frame = Frame::usual;
  int priority = 1;    // smaller acts first; equal ones form one compound task
  int first_axis = 0;  // into ControlSet::axes
  int axis_count = 0;
  bool fresh = false;  // in force since this tick: all its integrals start at 0
};

// Tension between two contacts. Positive pushes the contacts apart.
struct InternalCommand {
  int instance = 0;   // index into Behavior::internal_instances
  int contact_a = 0;  // contact indices of the robot
  int contact_b = 0;
  double reference = 0.0;  // N, force at each contact (`mean` convention)
  double feedback = 0.0;   // K_F on the measured force
  double scale = 1.0;      // mean force over what the behavior writes: 0.5 for `sum`
};

// One complete control law: contacts that hold, tasks by priority, internal forces.
struct ControlSet {
  int contact_count = 0;
  std::array<int, core::kMaxContacts> contacts{};  // robot contact indices, no duplicates
  int task_count = 0;
  std::array<TaskCommand, core::kMaxTasks> tasks{};  // ascending priority, stable by document order
  int axis_count = 0;
  std::array<AxisCommand, core::kMaxAxes> axes{};
  int internal_count = 0;
  std::array<InternalCommand, core::kMaxInternal> internals{};
};

// How a contact transition is computed.
enum class TransitionForm : std::uint8_t {
  continuous,  // both controllers at every tick, torques blended: exact at both ends
  frozen,      // [Kim16] eqs (1)-(2): foot force taken once at entry, ramped into the single law
};

// The machine's answer for a tick.
struct ActiveControl {
  ControlSet primary;         // of the active configuration
  bool has_other = false;     // a contact transition is under way
  ControlSet other;           // the stack left (releases) or the one to come (loads)
  double other_weight = 0.0;  // 0..1, of `other`
  TransitionForm form = TransitionForm::continuous;
  bool transition_entered = false;  // first tick of the transition (frozen form samples here)
  int moving_contact_count = 0;     // feet released or loaded
  std::array<int, core::kMaxContacts> moving_contacts{};
};

}  // namespace footfall::tasks
