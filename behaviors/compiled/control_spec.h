// The control of a statechart's configurations: compiled tasks, references and contacts as flat
// arrays, one ControlSpec for each combination of states that differ in control.
#pragma once

#include <array>
#include <vector>

#include "behaviors/compiled/chart.h"
#include "behaviors/compiled/trajectory.h"
#include "hal/actuators/torque_loop.h"
#include "tasks/active_set.h"

namespace footfall::behaviors {

// One axis of a task. Gains are slots of the parameter array, -1 for 0; the others are expressions,
// -1 for the default of tasks::AxisCommand.
struct AxisSpec {
  int axis = 0;
  int kp = -1, ki = -1, kd = -1;
  std::array<int, 3> computed{-1, -1, -1};  // expressions for kp, ki, kd without slot
  int weight = -1;
  int acceleration_limit = -1;
  int integral_limit = -1;
  int value = -1;         // reference kind `value`: position; trajectories: `to`, -1: stays
  int end_velocity = -1;  // trajectories, -1: 0
  int radius = -1;        // ellipse: expression, -1: 0
  int phase = -1;         // ellipse: expression, -1: 0
  core::Mark mark;        // of its item in `axes` or `joints`, else of the list, else of the task
  core::Mark value_mark;  // position of the source of `value`
};

// A point passed by a trajectory: time and position.
struct WaypointSpec {
  int at = -1;  // expression of a time; -1: `part` of the trajectory's `over`
  double part = 1.0;
  bool after_previous = false;  // `at` counts from the previous point, not from the start
  std::vector<int> to;          // expressions by axis of the task, -1: axis not included
};

// Source of a task's reference. `owner` is the state whose entry starts a trajectory.
struct ReferenceSpec {
  enum class Kind : std::uint8_t { none, value, trajectory };
  Kind kind = Kind::none;
  Shape shape = Shape::hold;
  int owner = 0;
  // Identifies its YAML and owner: a task whose other keys change keeps its trajectory.
  int source = -1;
  int over = -1;  // expression of a time; ellipse, surface: of the centre, of the height above
  core::Mark over_mark;
  int period = -1;         // ellipse: expression of a time
  int ramp = -1;           // ellipse: expression of a time, -1: one period
  double direction = 1.0;  // ellipse: 1 from its first axis towards the others, -1 reverse
  Range waypoints;         // into Behavior::waypoints
  // Fraction of the trajectory's time during which it follows a changing `to`; 0: never. Following
  // until the very end would require unbounded accelerations. `retarget: true` is 80 %.
  double retarget = 0.0;
};

struct TaskSpec {
  int instance = 0;  // into Behavior::task_instances
  tasks::TaskType type = tasks::TaskType::com_position;
  int point = -1;
  tasks::Frame frame = tasks::Frame::world;
  int priority = 1;
  Range axes;  // into Behavior::axes
  ReferenceSpec reference;
  core::Mark mark;  // of the task's name
};

// Of the low-pass of a measured internal force, where a behavior names none.
inline constexpr double kInternalBandwidth = 20.0;  // Hz

struct InternalSpec {
  int instance = 0;               // into Behavior::internal_instances
  int contact_count = 2;          // 2: a tension; 4: the vertical warp
  std::array<int, 4> contacts{};  // of the robot
  // Kind `value`: expression `value`, N as the behavior writes it; trajectory: its `to`.
  ReferenceSpec reference;
  int value = -1;
  int end_velocity = -1;    // trajectories: expression, N/s
  int statics = -1;         // expression, part of the force by statics; -1: none
  int feedback = -1;        // expression, -1: 0
  int integral = -1;        // expression, 1/s, -1: 0
  int integral_limit = -1;  // expression, N as the behavior writes it, -1: none
  int bandwidth = -1;       // expression, Hz, -1: kInternalBandwidth
  int ramp = -1;            // expression of a time, -1: 0 s
  double scale = 1.0;       // of what is written in N: 0.5 for `sum`, 0.25 for that of a warp
  core::Mark mark;          // of its reference
};

// A torque-continuous change of the contact set.
struct TransitionSpec {
  int owner = 0;       // state that declares it
  bool loads = false;  // otherwise releases
  int over = -1;       // expression of a time
  int toward = -1;     // index into Behavior::controls
  tasks::TransitionForm form = tasks::TransitionForm::continuous;
  std::vector<int> contacts;  // that are released or loaded
};

struct ControlSpec {
  std::vector<int> contacts;
  Range tasks;          // into Behavior::tasks, by priority, then in document order
  Range internals;      // into Behavior::internals
  int transition = -1;  // into Behavior::contact_transitions
  // By joint: index into Behavior::torque_loops, -1: the robot's own gains; empty: of all joints.
  std::vector<int> torque_loops;
};

// A table of gains of the actuators' own torque loops. The gains in force: torque_loops.h.
struct TorqueLoopTable {
  std::string name;
  hal::TorqueLoopGains::Type type = hal::TorqueLoopGains::Type::cascade;
  // By model::kTorqueLoopGainKeys: the first slot of one value a joint, -1 if the table does not
  // name the gain.
  std::array<int, 7> slots{-1, -1, -1, -1, -1, -1, -1};
  // By joint: type, damping, and the gains that the table does not name.
  std::vector<hal::TorqueLoopGains> unnamed;
  std::array<std::vector<core::Mark>, 7> marks;  // of the values, by gain and joint
  core::Mark mark;                               // of the table's name
};

// One `invoke` of a planner.
struct InvokeInfo {
  core::Mark at_mark;  // of the key that defines when it is asked
  int state = 0;
  int planner = 0;
  int at = -1;                  // expression of a time in the state; -1: at_fraction of `after`
  double at_fraction = 0.0;     // if after >= 0
  int after = -1;               // expression of the state's own duration
  int every = -1;               // expression of a time; -1: asked once
  int deadline = -1;            // expression of a time; -1: none
  bool closed_form = false;     // replaces a late plan; otherwise the last plan is kept
  int stance = -1, swing = -1;  // contact indices
  int switch_in = -1;           // expression of a time
  core::Mark mark;
};

}  // namespace footfall::behaviors
