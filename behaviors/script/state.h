// What the files of the Lua door share; see script.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "behaviors/script/script.h"

struct lua_State;

namespace footfall::behaviors {

// One Lua state and what its C functions reach through the registry.
struct ScriptState {
  lua_State* lua = nullptr;
  ScriptSettings settings;
  std::size_t memory_used = 0;
  std::int64_t instructions_left = 0;
  std::vector<std::string> patterns;  // of footfall.on; handlers are in the registry by index
  std::vector<int> handlers;          // registry references
  const ScriptView* view = nullptr;   // during a call
  ScriptAnswer* answer = nullptr;
};

// The state that a C function of this Lua belongs to.
ScriptState& state_of(lua_State* lua);
// Opens the libraries that the access allows, and takes out what loads code or reads clocks.
void open_libraries(lua_State* lua, const ScriptSettings& settings);
// Puts the table `footfall` into the globals.
void open_footfall(lua_State* lua);
// `goal`, `goal.x`: the parameter's first slot and number of values; -1 and a reason otherwise.
int find_parameter_slots(const Behavior& behavior, const std::string& name, int& size, double& min,
                         double& max, std::string& why);

}  // namespace footfall::behaviors
