// Checks of a behavior's physics before a motor moves: tasks that no contact can produce,
// conflicting tasks, uncontrolled degrees of freedom, references out of reach, internal forces
// outside the friction cone, unstable planners, torque steps at contact changes. Load time only;
// `footfall check` and `footfall run` call it after the loader.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "core/diagnostics/diagnostics.h"
#include "model/terrain.h"

namespace footfall::behaviors {

// What the checks take from the world that a behavior is to run in; the default is the default
// world, with each contact's friction as in the robot file.
struct PhysicsWorld {
  std::optional<double> friction{};  // of the ground: with it a foot has the lesser of both
  int steps_per_tick = 2;
  double command_delay = 0.0;  // s, from the tick's command to the torque
  bool series_elastic = false;
  double measurement_delay = 0.0;  // s, from the drives' measurement to the tick
  double viscous = 0.0;            // N m s/rad, of every rotor
  // Name of a world in which nothing but its contacts bears the robot; empty: not known.
  std::string unaided{};
  model::Terrain terrain{};  // as the controller believes it
  // LoadOptions::world of a behavior that is to be checked in it; none: the robot is as its file
  // is.
  std::function<void(model::RobotDescription&, core::Diagnostics&)> actuators{};
  // By joint: how the world's start differs from the robot's posture, rad; none: not at all.
  std::function<std::vector<double>(const model::RobotDescription&)> start_joints{};
};

// Evaluated at the posture in which the world starts the robot (the robot file's, unless the world
// says otherwise) and at kSeededPostures around it (postures.h):
// an error if a configuration is deficient in all of them, a warning if in some. No effect for a
// behavior without a robot. Throws std::runtime_error with one sentence if the robot's model cannot
// be compiled.
void check_physics(const Behavior& behavior, core::Diagnostics& diagnostics,
                   const PhysicsWorld& world = {});

// Its part of how a run begins: a warning where the first law has tasks and no contact. `unaided`
// as in PhysicsWorld.
void check_first_support(const Behavior& behavior, const std::string& unaided,
                         core::Diagnostics& diagnostics);

// check_physics() as LoadOptions::check: a model that cannot be compiled is one more error.
std::function<void(const Behavior&, core::Diagnostics&)> physics_check(
    const PhysicsWorld& world = {});

// The same checks of a behavior with other values of its parameters and gains: what a live edit or
// a scenario's would lead to. Keeps a copy of the behavior and its model; not for the tick.
class EditedValues {
 public:
  explicit EditedValues(const Behavior& behavior, const PhysicsWorld& world = {});
  ~EditedValues();

  // The errors with which `run` would refuse these values (of Behavior::values, by slot).
  std::vector<core::Diagnostic> errors(std::span<const double> values);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::behaviors
