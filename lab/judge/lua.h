// Functions of Lua that a scenario's script calls, between two ticks: they see the robot as the
// last tick left it, and what they want enters by the door that edits have.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "behaviors/script/watched.h"
#include "engine/tick/control_loop.h"
#include "lab/scenario/description.h"

namespace footfall::lab {

class ScenarioLua {
 public:
  // Runs the scenario's files, which the loader has found good; `seed`: of math.random.
  ScenarioLua(const ScenarioDescription& scenario, engine::ControlLoop& loop, std::uint64_t seed);

  struct Result {
    engine::EditBatch batch;            // what it set and raised; empty: nothing
    std::vector<std::string> messages;  // what it logged, and why it failed
    bool failed = false;
  };
  Result call(const std::string& function);

 private:
  engine::ControlLoop& loop_;
  std::shared_ptr<behaviors::Script> script_;
  std::vector<std::uint8_t> active_;
};

}  // namespace footfall::lab
