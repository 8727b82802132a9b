// A compiled behavior: immutable flat arrays, built at load, indexed by small integers.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/compiled/chart.h"
#include "behaviors/compiled/control_spec.h"
#include "behaviors/compiled/estimator_spec.h"
#include "behaviors/compiled/script_limits.h"
#include "behaviors/compiled/signals.h"
#include "behaviors/expression/parameter.h"
#include "behaviors/planners/foot_planner.h"
#include "core/fault.h"
#include "core/signal_table.h"
#include "core/units/units.h"
#include "model/robot/description.h"
#include "tasks/active_set.h"

namespace footfall::behaviors {

// Identity of a task across states: same name, type and point keep reference and integral.
struct TaskInstance {
  std::string name;
  tasks::TaskType type = tasks::TaskType::com_position;
  int point = -1;   // index into the model's points (contacts first, then points of the robot file)
  int signals = 0;  // index into SignalLayout::task: tasks of the same name share their signals
};

// A Lua file as read at load; a run uses this text.
struct ScriptFile {
  std::string path;
  std::string text;
};

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

struct PlannerInfo {
  std::string name;
  FootPlannerSpec spec;      // its kappa is used only without kappa_parameter
  int kappa_parameter = -1;  // index into Behavior::parameters, one value or one for each of x y
  int kappa_slot = -1;       // slot of that parameter's first value
  int kappa_size = 0;
  int goal_slot = -1;        // parameter slot of the goal's x (y follows); -1: constant
  std::vector<double> goal;  // constant goal
  int done_event = -1, late_event = -1, failed_event = -1;
  core::Mark mark;  // of `kappa`, else of the planner's name
};

// A time that depends on parameters, where the file uses it.
struct TimeUse {
  int expression = -1;
  int guard = -1;         // condition under which a transition uses it, -1: none
  bool positive = false;  // must be above 0 s
  int state = -1;         // that contains it
  core::Mark mark;
};

// The statechart's arrays (Chart) and, with a robot, its control.
struct Behavior : Chart {
  std::string name;  // of the file, without folder and extension
  std::string path;
  std::vector<std::string> files;  // all files read: its own, bases, robot
  bool has_robot = false;          // false: a pure statechart
  model::RobotDescription robot;

  core::SignalTable signals;  // prototype with names, units, zeros; copied by each run
  SignalLayout layout;

  std::vector<ParameterInfo> parameters;  // including gains
  std::vector<double> values;             // initial values, by slot

  std::vector<ControlSpec> controls;  // by Statechart::control()
  std::vector<TaskSpec> tasks;
  std::vector<AxisSpec> axes;
  std::vector<WaypointSpec> waypoints;
  // Minimum and maximum of kp, ki, kd given by expressions: 0 or more, or gains.ranges.
  std::array<std::array<double, 2>, 3> gain_limits = {
      {{0.0, kUnlimited}, {0.0, kUnlimited}, {0.0, kUnlimited}}};
  std::vector<InternalSpec> internals;
  std::vector<TransitionSpec> contact_transitions;
  std::vector<TorqueLoopTable> torque_loops;
  EstimatorSpec estimator;
  std::vector<std::string> stacks;  // names, as written

  std::vector<TaskInstance> task_instances;
  std::vector<std::string> internal_instances;
  std::vector<TaskName> task_names;  // index: TaskInstance::signals
  std::vector<PlannerInfo> planners;
  std::vector<InvokeInfo> invokes;
  std::vector<TimeUse> times;  // except constants
  std::vector<ScriptFile> scripts;
  ScriptLimits script_limits;

  int step = -1;                                      // index of the mark `step`, -1 if not used
  std::vector<int> touchdown_events, liftoff_events;  // by contact
  std::vector<int> fault_events;                      // by core::Fault
  std::vector<int> changed_events;                    // by parameter, parameter.changed.NAME
  bool watches_parameters = false;                    // whether a transition listens to these

  int find_event(std::string_view event) const;
  int find_state(std::string_view path) const;  // by full dotted path
  int find_parameter(std::string_view parameter) const;
  // `goal`, or one of its components: `goal.y`.
  ParameterPart find_parameter_part(std::string_view name) const;
  // Index of the parameter that a slot belongs to, -1 if absent.
  int parameter_of_slot(int slot) const;
};

}  // namespace footfall::behaviors
