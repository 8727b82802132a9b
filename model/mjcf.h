// Loading a robot's MJCF into MuJoCo, shared by the control model and the simulator.
#pragma once

#include <string>
#include <vector>

struct mjModel_;

namespace footfall::model {

// Compiles `xml` (a whole MJCF document that may include files by absolute path). Throws
// std::runtime_error with MuJoCo's own text; `what` names the thing in the message.
mjModel_* compile_mjcf(const std::string& xml, const std::string& what);

// The robot alone with all its shapes, and the settings of its own file.
mjModel_* load_whole_model(const std::string& model_path);

// The robot alone, as physics needs it: shapes that are only seen are left out, since kinematics
// would otherwise carry every one of them. Gravity and the like are the world's, see
// use_own_settings().
mjModel_* load_robot_model(const std::string& model_path);

// Puts MuJoCo's defaults in place of what a robot's <option> says beyond a world's own settings
// (step, integrator, solver, cone, impratio, iterations, tolerance): gravity, wind, medium, flags.
void use_own_settings(mjModel_& m);

// The names of its bodies, without the world and those that have none. Throws like the others.
std::vector<std::string> body_names(const std::string& model_path);

}  // namespace footfall::model
