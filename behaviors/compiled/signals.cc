// The order in which signals are registered; see signals.h.
#include "behaviors/compiled/signals.h"

#include <algorithm>

namespace footfall::behaviors {
namespace {

using core::Dimension;

// Registers NAME.x, NAME.y, NAME.z (or other axes) and returns the first index.
int add_axes(core::SignalTable& table, const std::string& name, Dimension dimension,
             const std::string& doc, const std::vector<std::string>& axes = {"x", "y", "z"}) {
  int first = -1;
  for (const std::string& axis : axes) {
    const int index = table.add(name + "." + axis, dimension, doc);
    if (first < 0) first = index;
  }
  return first;
}

void add_body(core::SignalTable& table, SignalLayout& layout) {
  layout.time = table.add("time", core::kTime, "time since the start");
  layout.com_pos = add_axes(table, "com.pos", core::kLength, "centre of mass, world");
  layout.com_vel = add_axes(table, "com.vel", core::kVelocity, "its velocity, world");
  layout.com_ref = add_axes(table, "com.ref", core::kLength, "its reference, world");
  layout.base_pos = add_axes(table, "base.pos", core::kLength, "base origin, world");
  layout.base_vel = add_axes(table, "base.vel", core::kVelocity, "its velocity, world");
  layout.base_rpy = add_axes(table, "base.rpy", core::kNone, "roll, pitch and yaw of the base",
                             {"roll", "pitch", "yaw"});
  layout.base_angvel =
      add_axes(table, "base.angvel", core::kRate, "angular velocity of the base, its own axes");
  layout.centroidal_momentum =
      add_axes(table, "centroidal.linear", core::kImpulse, "linear momentum, world");
  add_axes(table, "centroidal.angular", core::kAngularMomentum,
           "angular momentum about the centre of mass, world");
}

void add_robot(const model::RobotDescription& robot, core::SignalTable& table,
               SignalLayout& layout) {
  for (const auto& contact : robot.contacts) {
    layout.contact.push_back(
        table.add("contact." + contact.name, core::kNone, "1 while its switch is closed"));
  }
  for (const auto& contact : robot.contacts) {
    layout.support.push_back(table.add("support." + contact.name, core::kNone,
                                       "1 while in the contact set of the control law"));
  }
  for (const auto& contact : robot.contacts) {
    layout.force.push_back(add_axes(table, "force." + contact.name, core::kForce,
                                    "measured force, ground on robot, world"));
  }
  for (const auto& contact : robot.contacts) {
    layout.force_cmd.push_back(
        add_axes(table, "force_cmd." + contact.name, core::kForce,
                 "force predicted by the control law, ground on robot, world"));
  }
  for (const auto& contact : robot.contacts) {
    layout.force_est.push_back(
        add_axes(table, "force_est." + contact.name, core::kForce,
                 "force that the measured joint torques give, ground on robot, world"));
  }
  for (const auto& contact : robot.contacts) {
    layout.point.push_back(
        add_axes(table, "point." + contact.name, core::kLength, "contact point, world"));
  }
  for (const auto& point : robot.points) {
    layout.point.push_back(
        add_axes(table, "point." + point.name, core::kLength, "named point, world"));
  }
  for (const auto& joint : robot.joints) {
    const std::string name = "joint." + joint.name;
    layout.joint.push_back(table.add(name + ".position", core::kNone, "joint position"));
    table.add(name + ".velocity", core::kRate, "joint velocity");
    table.add(name + ".torque", core::kTorque, "measured joint torque");
    table.add(name + ".command", core::kTorque, "commanded joint torque");
    table.add(name + ".motor", core::kTorque, "motor torque of a series-elastic actuator, else 0");
  }
}

TaskSignals add_task(const TaskName& task, core::SignalTable& table) {
  const std::string name = "task." + task.name;
  const bool lengths = std::find(task.dimensions.begin(), task.dimensions.end(), core::kLength) !=
                       task.dimensions.end();
  const Dimension norm = lengths                   ? core::kLength
                         : task.dimensions.empty() ? core::kNone
                                                   : task.dimensions.front();
  const Dimension per = task.is_rate ? core::kTime : core::kTime * core::kTime;
  TaskSignals signals;
  signals.axis_count = static_cast<int>(task.axes.size());
  signals.error = table.add(name + ".error", norm, "norm of the error over its axes");
  for (const Dimension dimension : task.dimensions) signals.in_norm.push_back(dimension == norm);
  const auto add_each = [&](const std::string& what, Dimension divisor, const std::string& doc,
                            std::vector<int>& out) {
    for (std::size_t k = 0; k < task.axes.size(); ++k) {
      out.push_back(
          table.add(name + "." + what + "." + task.axes[k], task.dimensions[k] / divisor, doc));
    }
  };
  add_each("error", core::kNone, "reference minus measured", signals.axis_error);
  add_each("reference", core::kNone, "reference", signals.axis_reference);
  add_each("measured", core::kNone, "measured value", signals.axis_measured);
  add_each("commanded", per, "commanded acceleration", signals.axis_commanded);
  add_each("achieved", per, "achieved acceleration, by the control model", signals.axis_achieved);
  signals.rank = table.add(name + ".rank", core::kNone, "rank of its priority level");
  signals.condition =
      table.add(name + ".condition", core::kNone,
                "longest row of all tasks over the smallest pivot of its priority level");
  signals.authority = table.add(name + ".authority", core::kNone,
                                "feasible part of the commanded accelerations: 1 all, 0 none");
  return signals;
}

PlannerSignals add_planner(const std::string& planner, core::SignalTable& table) {
  const std::string name = "planner." + planner;
  PlannerSignals signals;
  signals.target = add_axes(table, name + ".target", core::kLength, "planned foothold, world");
  signals.predicted_pos = add_axes(table, name + ".predicted_pos", core::kLength,
                                   "centre of mass at the switch as predicted, world", {"x", "y"});
  signals.predicted_vel =
      add_axes(table, name + ".predicted_vel", core::kVelocity,
               "centre of mass velocity at the switch as predicted, world", {"x", "y"});
  signals.extension =
      table.add(name + ".extension", core::kTime, "landing delay requested by the swing-time rule");
  signals.switch_time = table.add(name + ".switch_time", core::kTime, "time of the support change");
  signals.late = table.add(name + ".late", core::kNone, "1 while its last answer was late");
  return signals;
}

EstimateSignals add_estimate(core::SignalTable& table) {
  EstimateSignals signals;
  signals.gyro_bias = add_axes(table, "estimate.gyro_bias", core::kRate,
                               "bias of the gyroscope as estimated, IMU frame");
  signals.accelerometer_bias = add_axes(table, "estimate.accelerometer_bias", core::kAcceleration,
                                        "bias of the accelerometer as estimated, IMU frame");
  signals.attitude = add_axes(table, "estimate.sigma", core::kNone,
                              "standard deviation of the base's orientation, world axes",
                              {"roll", "pitch", "yaw"});
  signals.position = add_axes(table, "estimate.sigma.position", core::kLength,
                              "standard deviation of the base's position, world");
  signals.velocity = add_axes(table, "estimate.sigma.velocity", core::kVelocity,
                              "standard deviation of the base's velocity, world");
  signals.markers = table.add("estimate.markers", core::kNone, "markers used of the last frame");
  signals.marker_innovation = table.add("estimate.innovation.marker", core::kLength,
                                        "marker measured minus predicted, rms over those seen");
  signals.kinematic_innovation =
      table.add("estimate.innovation.kinematic", core::kNone,
                "contact measured minus predicted, largest of the contacts; m/s or m, by the "
                "estimator");
  return signals;
}

TruthSignals add_truth(core::SignalTable& table) {
  TruthSignals signals;
  signals.com_pos = add_axes(table, "truth.com.pos", core::kLength,
                             "true centre of mass, world; only a simulator knows it");
  signals.base_pos = add_axes(table, "truth.base.pos", core::kLength, "true base origin, world");
  signals.base_vel = add_axes(table, "truth.base.vel", core::kVelocity, "its true velocity, world");
  signals.base_rpy = add_axes(table, "truth.base.rpy", core::kNone,
                              "true roll, pitch and yaw of the base", {"roll", "pitch", "yaw"});
  signals.gyro_bias =
      add_axes(table, "truth.gyro_bias", core::kRate, "true bias of the gyroscope, IMU frame");
  signals.accelerometer_bias = add_axes(table, "truth.accelerometer_bias", core::kAcceleration,
                                        "true bias of the accelerometer, IMU frame");
  return signals;
}

}  // namespace

SignalLayout register_signals(const model::RobotDescription& robot,
                              const std::vector<TaskName>& tasks,
                              const std::vector<std::string>& internals,
                              const std::vector<std::string>& planners, core::SignalTable& table,
                              bool estimated) {
  SignalLayout layout;
  add_body(table, layout);
  add_robot(robot, table, layout);
  for (const TaskName& task : tasks) layout.task.push_back(add_task(task, table));
  for (const std::string& internal : internals) {
    const std::string name = "internal." + internal;
    layout.internal.push_back(
        {table.add(name + ".reference", core::kForce, "internal force, reference"),
         table.add(name + ".measured", core::kForce, "internal force, measured")});
  }
  for (const std::string& planner : planners) {
    layout.planner.push_back(add_planner(planner, table));
  }
  layout.steps = table.add("steps", core::kNone, "steps counted by `mark: step`");
  layout.state = table.add("state", core::kNone, "index of the first active atomic state");
  layout.transition_weight =
      table.add("transition.weight", core::kNone, "weight of the second control law, 0 to 1");
  layout.motor_saturated = table.add("motor.saturated", core::kNone,
                                     "1 while a motor gives less than its torque loop asks for");
  layout.aid_force =
      add_axes(table, "aid.force", core::kForce,
               "external aids' force on the robot, of a simulator, world", {"x", "y", "z"});
  layout.torque_step =
      table.add("torque.step", core::kTorque, "largest torque step of a joint between two ticks");
  layout.faults = table.add("faults", core::kNone, "faults counted so far");
  layout.tick_late =
      table.add("tick.late", core::kNone, "ticks so far that began late; 0 in lock-step");
  layout.goal = add_axes(table, "goal", core::kLength, "target position", {"x", "y"});
  if (!estimated) return layout;
  layout.estimate = add_estimate(table);
  layout.truth = add_truth(table);
  return layout;
}

}  // namespace footfall::behaviors
