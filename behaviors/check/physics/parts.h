// The parts of check_physics; see check.h. Load time only.
#pragma once

#include <string>
#include <vector>

#include "behaviors/check/physics/check.h"
#include "behaviors/check/physics/findings.h"
#include "behaviors/check/physics/law.h"
#include "behaviors/compiled/behavior.h"
#include "behaviors/compiled/static_values.h"
#include "model/control_model.h"
#include "model/state.h"

namespace footfall::behaviors {

// Input of all parts.
struct PhysicsContext {
  const Behavior& behavior;
  model::ControlModel& model;  // updated by the caller to the posture in question
  PhysicsLaw& law;
  const std::vector<model::State>& postures;  // the first is the nominal one
  PhysicsFindings& findings;
  const PhysicsWorld& world;
};

// `right_foot and left_foot`, or `no contact`.
std::string contacts_text(const Behavior& behavior, const std::vector<int>& contacts);
// Name of an axis of a task: `yaw`, `z`, `left_knee`.
std::string axis_name(const Behavior& behavior, const TaskRow& row);

// Tasks that no contact can produce, in the model's current posture (rank.cc).
void check_ranks(PhysicsContext& context, const ControlSpec& control, core::Mark state);
// Internal forces against the friction cone, in all postures in which the robot can stand without
// them (friction_cone.cc).
void check_internal_forces(PhysicsContext& context, const ControlSpec& control);
// References against joint limits, legs' reach and the robot's tilt limit (reach.cc).
void check_references(PhysicsContext& context);
// Feedback of internal forces beyond what the loop bears (check/actuators/force_feedback.cc).
void check_force_feedback(PhysicsContext& context);
// References that move without a velocity of their own (feed_forward.cc).
void check_feed_forward(PhysicsContext& context);
// Gains that are unstable at the robot's rate (gain_stability.cc).
void check_gains(PhysicsContext& context);
// Torque loops that are unstable or not passive (check/actuators/torque_loops.cc).
void check_torque_loops(PhysicsContext& context);
// Step-to-step maps of the planners (planner_stability.cc).
void check_planners(PhysicsContext& context);
// Values over the ranges of live parameters, each with the others at their values
// (live_ranges.cc).
void check_live_ranges(const Behavior& behavior, const PhysicsWorld& world,
                       core::Diagnostics& diagnostics);
// Torque steps where contacts change (torque_steps.cc).
void check_torque_steps(PhysicsContext& context);

}  // namespace footfall::behaviors
