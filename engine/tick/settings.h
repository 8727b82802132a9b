// How a control loop is set up, beside its behavior and hardware.
#pragma once

#include <cstdint>

#include "behaviors/script/script.h"
#include "model/control_model.h"
#include "model/height_surface.h"

namespace footfall::engine {

struct LoopSettings {
  model::ModelDeviation deviation;  // of the control model from the robot file
  double planner_latency = 2e-3;    // s, lock-step
  bool lockstep = true;             // the caller's clock waits for what other threads compute
  behaviors::ScriptAccess script_access;
  bool waits = true;             // for a first state; false: a replay, whose log begins with it
  bool run_scripts = true;       // false: a replay, which has their answers
  std::uint64_t seed = 0;        // of the scripts' random numbers
  model::HeightSurface surface;  // of the world, for references that follow it
};

}  // namespace footfall::engine
