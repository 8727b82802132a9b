// What a log keeps of how its run was set up, so that it can be replayed by itself: every file the
// run was loaded from, and the settings of the control loop as JSON whose numbers are exact.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/log/writer.h"
#include "engine/tick/control_loop.h"

namespace footfall::lab {

struct LogSource;

// The behavior's file, robot, scripts and model, the world's file, and all that these name: bases,
// included models, meshes. As they are on the disk now; what is gone is left out.
std::vector<engine::LogFile> source_files(const behaviors::Behavior& behavior,
                                          const std::string& world_file);

// JSON: paths, --set texts, settings of the loop.
std::string setup_text(const behaviors::Behavior& behavior, const LogSource& source);

// Of the log of a reload: how it goes on from the one before.
struct LogContinuation {
  int number = 0;          // of the reload; 0: the log begins with its run
  bool back = false;       // the behavior from before the last one goes on
  std::int64_t watch = 0;  // of its first ticks, in which faults bring the one before back
};

// The same of a log that goes on from another.
std::string setup_text(const std::string& text, const LogContinuation& continues);

// What setup_text() told.
struct RunSetup {
  std::string behavior_file, robot_file;  // absolute
  std::vector<std::pair<std::string, std::string>> set;
  engine::LoopSettings settings;
  LogContinuation continues;
  model::Terrain terrain;  // of the simulation
  // Actuators of the world in the place of the robot's file's, by joint; empty: it has none.
  std::vector<double> springs;  // N m/rad
  double command_limit = 1.0;   // model::RobotDescription::command_limit
  std::vector<hal::TorqueLoopGains> torque_loop;
};
// The ground as it is in the simulation and as the controller believes it; level if the text does
// not say.
struct Grounds {
  model::Terrain truth, belief;
};
Grounds grounds_of(const std::string& setup_text);
// Gives the robot of the log the actuators of its world: LoadOptions::world of a replay.
std::function<void(model::RobotDescription&, core::Diagnostics&)> actuators_of(
    const RunSetup& setup);
// Throws std::runtime_error with one sentence if the text is not of that kind.
RunSetup read_setup(const std::string& text);

// The linker's id of this program, hexadecimal; empty if it has none.
std::string build_id();

}  // namespace footfall::lab
