// A behavior of the library on the MuJoCo backend, ready to tick: shared by regression tests and
// benchmarks.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include "behaviors/loader.h"
#include "engine/tick/control_loop.h"
#include "sim/mujoco_backend.h"
#include "sim/world/description.h"

namespace footfall::tests {

struct Rig {
  std::unique_ptr<behaviors::Behavior> behavior;
  sim::WorldDescription world;
  std::unique_ptr<sim::MujocoBackend> backend;
  std::unique_ptr<engine::ControlLoop> loop;

  // behavior: a name in behaviors/library or a path. Throws std::runtime_error with all messages.
  explicit Rig(const std::string& name, const sim::WorldDescription& in = sim::WorldDescription())
      : world(in) {
    core::Diagnostics diagnostics;
    behaviors::LoadOptions options;
    options.search = {FOOTFALL_SOURCE_DIR};
    const std::string path =
        name.find('/') == std::string::npos
            ? std::string(FOOTFALL_SOURCE_DIR) + "/behaviors/library/" + name + ".yaml"
            : name;
    behavior = behaviors::load_behavior(path, options, diagnostics);
    if (!behavior) throw std::runtime_error(diagnostics.to_string());
    backend = std::make_unique<sim::MujocoBackend>(behavior->robot, world);
    engine::LoopSettings settings;
    settings.deviation = world.control_model;
    settings.planner_latency = world.planner_latency;
    loop = std::make_unique<engine::ControlLoop>(*behavior, *backend, settings);
  }
};

}  // namespace footfall::tests
