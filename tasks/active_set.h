// What the state machine asks of the whole-body controller in this tick: plain numbers only.
// Written by behaviors/ every tick, read by tasks/solver/wbosc. Capacities are fixed.
#pragma once

#include <array>
#include <cstdint>

#include "core/capacities.h"
#include "tasks/rows/axis.h"
#include "tasks/task_types.h"

namespace footfall::tasks {

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

// Tension between two contacts, positive: pushes them apart; or the vertical warp of four,
// positive: loads the first and third, unloads the second and fourth.
struct InternalCommand {
  int instance = 0;               // index into Behavior::internal_instances
  int contact_count = 2;          // 2 or 4
  std::array<int, 4> contacts{};  // contact indices of the robot
  double reference = 0.0;         // N, force at each contact (`mean` convention)
  double statics = 0.0;           // not 0: the reference is this part of that of statics.h
  double feedback = 0.0;          // K_F on the measured force
  double integral = 0.0;          // K_I, 1/s, of the same error
  double integral_limit = -1.0;   // N, of what the integral adds; negative: none
  double bandwidth = 0.0;         // Hz, of the measured force's low-pass; 0: none
  double ramp = 0.0;              // s, in which the reference grows from 0 N
  double scale = 1.0;             // mean force over what the behavior writes: 0.5 for `sum`
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
