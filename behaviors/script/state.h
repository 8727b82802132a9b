// Internals shared by the files of this folder; see script.h.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "behaviors/script/script.h"

struct lua_State;

namespace footfall::behaviors {

// One Lua state and the data that its C functions find through the registry.
struct ScriptState {
  lua_State* lua = nullptr;
  ScriptSettings settings;
  std::size_t memory_used = 0;
  std::int64_t instructions_left = 0;
  std::vector<std::string> patterns;  // of footfall.on; the registry holds the handlers
  std::vector<int> handlers;          // registry references
  const ScriptView* view = nullptr;   // during a call
  std::mutex view_in_use;             // held by what looks at the view
  std::atomic<bool> stopped{false};
  ScriptAnswer* answer = nullptr;
};

// The ScriptState of a Lua state.
ScriptState& state_of(lua_State* lua);
// Opens the permitted libraries, and removes functions that load code or read clocks.
void open_libraries(lua_State* lua, const ScriptSettings& settings);
// Adds the table `footfall` to the globals.
void open_footfall(lua_State* lua);
// For `goal` or `goal.x`: the first slot and the number of values; -1 and a reason otherwise.
int find_parameter_slots(const Behavior& behavior, const std::string& name, int& size, double& min,
                         double& max, std::string& why);

}  // namespace footfall::behaviors
