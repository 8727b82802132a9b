// Loading a robot's MJCF (or URDF) into MuJoCo, shared by the control model and the simulator.
#pragma once

#include <string>
#include <vector>

struct mjModel_;

namespace footfall::model {

// Compiles `xml` (a whole MJCF document that may include files by absolute path). Throws
// std::runtime_error with MuJoCo's own text; `what` names the thing in the message.
mjModel_* compile_mjcf(const std::string& xml, const std::string& what);

// The robot alone, as physics needs it: shapes that are only seen are left out, since kinematics
// would otherwise carry every one of them.
mjModel_* load_robot_model(const std::string& model_path);

// The names of its bodies, without the world and those that have none. Throws like the others.
std::vector<std::string> body_names(const std::string& model_path);

}  // namespace footfall::model
