// Options of the loader besides the file.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

// A C++ function available to `call:` in behaviors.
struct NativeFunctionInfo {
  std::string name;
  NativeFunction function = nullptr;
};

struct LoadOptions {
  std::vector<std::string> search;  // folders of robots/NAME/robot.yaml, behaviors/library
  std::string robot;                // replaces the file's `robot:` if not empty
  std::vector<NativeFunctionInfo> functions;             // registered by the program
  std::vector<std::pair<std::string, std::string>> set;  // --set NAME=VALUE, in YAML notation
  // What the world in which it runs changes of the robot: its actuators. Called once the robot's
  // file is read.
  std::function<void(model::RobotDescription&, core::Diagnostics&)> world;
  // Further checks of a behavior without errors, as check_physics(). What they find in a base is
  // reported at the value of an overlay or of --set that it follows from.
  std::function<void(const Behavior&, core::Diagnostics&)> check;
};

// Search folders for `base: NAME`: behaviors/library in each folder of `search`.
std::vector<std::string> library_folders(const std::vector<std::string>& search);

}  // namespace footfall::behaviors
