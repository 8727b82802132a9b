// A robot of one body, without joints or contacts, for tests of external aids.
#pragma once

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "sim/mujoco_backend.h"
#include "sim/springs_check.h"

namespace footfall::sim {

class Brick : public testing::Test {
 protected:
  Brick() {
    robot_.name = "brick";
    robot_.path = "brick.yaml";
    robot_.floating_base = "brick";
    robot_.rate_mhz = 1'500'000;
    robot_.model_path = testing::TempDir() + "/footfall_brick_" + std::to_string(getpid()) + ".xml";
    std::ofstream(robot_.model_path)
        << "<mujoco><worldbody><body name=\"brick\" pos=\"0 0 10\"><freejoint/>"
           "<inertial pos=\"0 0 0\" mass=\"2\" diaginertia=\"0.01 0.02 0.025\"/>"
           "</body></worldbody></mujoco>";
    world_.physics.steps_per_tick = 2;
  }

  model::BodySprings& aid(const std::string& name = "aid") {
    model::BodySprings& out = world_.constraints.emplace_back();
    out.name = name;
    out.body.name = "brick";
    return out;
  }
  void start() {
    backend_ = std::make_unique<MujocoBackend>(robot_, world_);
    backend_->start();
  }
  double position(int axis) const { return backend_->data()->qpos[axis]; }
  double force(int axis) const { return backend_->data()->xfrc_applied[6 + axis]; }
  void ticks(int count) {
    for (int k = 0; k < count; ++k) backend_->write({});
  }
  std::string refusals(const std::vector<model::BodySprings>& holds = {}) {
    core::Diagnostics found;
    check_springs(world_, holds, robot_, found);
    std::string text;
    for (const core::Diagnostic& item : found.all()) text += item.text + "\n";
    return text;
  }

  model::RobotDescription robot_;
  WorldDescription world_;
  std::unique_ptr<MujocoBackend> backend_;
};

}  // namespace footfall::sim
