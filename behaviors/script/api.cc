// The table `footfall` available to scripts; see script.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <lua.hpp>

#include "behaviors/compiled/behavior.h"
#include "behaviors/script/state.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

constexpr std::size_t kMaxAnswers = 1000;  // limit of events, edits or messages of one call

using Body = int (*)(lua_State*, ScriptState&, std::string&);

int api_log(lua_State* lua, ScriptState& state, std::string& problem);

// Runs a body; a problem that it reports becomes a Lua error with the script's line. No body but
// api_log runs code of the script, so that the lock is never held for long.
template <Body body>
int guarded(lua_State* lua) {
  std::string problem;
  int results = 0;
  {
    ScriptState& state = state_of(lua);
    std::unique_lock lock(state.view_in_use, std::defer_lock);
    if (body != api_log) lock.lock();
    if (state.stopped) {
      problem = "stopped";
    } else {
      results = body(lua, state, problem);
    }
  }
  if (problem.empty()) return results;
  luaL_where(lua, 1);
  lua_pushlstring(lua, problem.data(), problem.size());
  lua_concat(lua, 2);
  return lua_error(lua);
}

// The text of argument `index`; empty and a problem otherwise.
std::string text_argument(lua_State* lua, int index, const char* what, std::string& problem) {
  if (lua_type(lua, index) == LUA_TSTRING) return lua_tostring(lua, index);
  problem = fmt::format("expected {}, got {}", what, luaL_typename(lua, index));
  return {};
}

bool in_call(const ScriptState& state, std::string& problem) {
  if (state.view != nullptr) return true;
  problem = "the robot is not there yet: use this inside a function";
  return false;
}

bool has_room(std::size_t count, std::string& problem) {
  if (count < kMaxAnswers) return true;
  problem = fmt::format("more than {} in one call", kMaxAnswers);
  return false;
}

int api_on(lua_State* lua, ScriptState& state, std::string& problem) {
  const std::string pattern = text_argument(lua, 1, "the name of an event", problem);
  if (!problem.empty()) return 0;
  if (!lua_isfunction(lua, 2)) {
    problem = fmt::format("expected a function, got {}", luaL_typename(lua, 2));
    return 0;
  }
  if (state.view != nullptr) {
    problem = "footfall.on belongs outside of functions";
    return 0;
  }
  if (!has_room(state.patterns.size(), problem)) return 0;
  lua_settop(lua, 2);
  state.handlers.push_back(luaL_ref(lua, LUA_REGISTRYINDEX));
  state.patterns.push_back(pattern);
  return 0;
}

int api_raise(lua_State* lua, ScriptState& state, std::string& problem) {
  const std::string name = text_argument(lua, 1, "the name of an event", problem);
  if (!problem.empty() || !in_call(state, problem)) return 0;
  const Behavior& behavior = *state.view->behavior;
  const int event = behavior.find_event(name);
  if (event < 0) {
    problem = fmt::format("unknown event '{}'{}", name, core::did_you_mean(name, behavior.events));
  } else if (has_room(state.answer->events.size(), problem)) {
    state.answer->events.push_back(event);
  }
  return 0;
}

void add_edit(ScriptState& state, int slot, double value, double min, double max,
              const std::string& name, std::string& problem) {
  if (!std::isfinite(value) || (min < max && (value < min || value > max))) {
    problem = fmt::format("{:g} is outside the range of '{}'", value, name);
  } else if (has_room(state.answer->edits.size(), problem)) {
    state.answer->edits.push_back({slot, value});
  }
}

int api_set(lua_State* lua, ScriptState& state, std::string& problem) {
  const std::string name = text_argument(lua, 1, "the name of a parameter", problem);
  if (!problem.empty() || !in_call(state, problem)) return 0;
  int size = 0;
  double min = 0.0, max = 0.0;
  const int slot = find_parameter_slots(*state.view->behavior, name, size, min, max, problem);
  if (slot < 0) return 0;
  if (lua_type(lua, 2) == LUA_TNUMBER) {
    for (int k = 0; k < size && problem.empty(); ++k) {
      add_edit(state, slot + k, lua_tonumber(lua, 2), min, max, name, problem);
    }
    return 0;
  }
  if (!lua_istable(lua, 2) || static_cast<int>(lua_rawlen(lua, 2)) != size) {
    problem = fmt::format("'{}' takes a number or a list of {}", name, size);
    return 0;
  }
  for (int k = 0; k < size && problem.empty(); ++k) {
    lua_rawgeti(lua, 2, k + 1);
    if (lua_type(lua, -1) != LUA_TNUMBER) problem = fmt::format("'{}' takes numbers", name);
    const double value = lua_tonumber(lua, -1);
    lua_pop(lua, 1);
    if (problem.empty()) add_edit(state, slot + k, value, min, max, name, problem);
  }
  return 0;
}

int api_get(lua_State* lua, ScriptState& state, std::string& problem) {
  const std::string name = text_argument(lua, 1, "the name of a signal", problem);
  if (!problem.empty() || !in_call(state, problem)) return 0;
  const core::SignalTable& signals = state.view->behavior->signals;
  const int index = signals.find(name);
  if (index < 0) {
    std::vector<std::string> names;
    for (const auto& info : signals.infos()) names.push_back(info.name);
    problem = fmt::format("unknown signal '{}'{}", name, core::did_you_mean(name, names));
    return 0;
  }
  lua_pushnumber(lua, state.view->signals[index]);
  return 1;
}

int api_parameter(lua_State* lua, ScriptState& state, std::string& problem) {
  const std::string name = text_argument(lua, 1, "the name of a parameter", problem);
  if (!problem.empty() || !in_call(state, problem)) return 0;
  int size = 0;
  double min = 0.0, max = 0.0;
  const int slot = find_parameter_slots(*state.view->behavior, name, size, min, max, problem);
  if (slot < 0) return 0;
  for (int k = 0; k < size; ++k) lua_pushnumber(lua, state.view->parameters[slot + k]);
  return size;
}

int api_active(lua_State* lua, ScriptState& state, std::string& problem) {
  const std::string name = text_argument(lua, 1, "the path of a state", problem);
  if (!problem.empty() || !in_call(state, problem)) return 0;
  const int index = state.view->behavior->find_state(name);
  if (index < 0) {
    std::vector<std::string> names;
    for (const StateInfo& info : state.view->behavior->states) names.push_back(info.path);
    problem = fmt::format("unknown state '{}'{}", name, core::did_you_mean(name, names));
    return 0;
  }
  lua_pushboolean(lua, state.view->active[index] != 0 ? 1 : 0);
  return 1;
}

int api_time(lua_State* lua, ScriptState& state, std::string& problem) {
  if (!in_call(state, problem)) return 0;
  lua_pushnumber(lua, state.view->time);
  return 1;
}

int api_log(lua_State* lua, ScriptState& state, std::string& problem) {
  if (!in_call(state, problem)) return 0;
  std::size_t length = 0;
  const char* text = luaL_tolstring(lua, 1, &length);
  constexpr std::size_t kLongest = 1000;  // bytes, maximum length of a message
  if (has_room(state.answer->messages.size(), problem)) {
    state.answer->messages.emplace_back(text, std::min(length, kLongest));
  }
  return 0;
}

}  // namespace

int find_parameter_slots(const Behavior& behavior, const std::string& name, int& size, double& min,
                         double& max, std::string& why) {
  const auto [index, component] = behavior.find_parameter_part(name);
  if (index < 0) {
    std::vector<std::string> names;
    for (const ParameterInfo& parameter : behavior.parameters) names.push_back(parameter.name);
    why = fmt::format("unknown parameter '{}'{}", name, core::did_you_mean(name, names));
    return -1;
  }
  const ParameterInfo& info = behavior.parameters[static_cast<std::size_t>(index)];
  size = component < 0 ? info.size : 1;
  min = info.min;
  max = info.max;
  return info.slot + std::max(component, 0);
}

void open_footfall(lua_State* lua) {
  const luaL_Reg functions[] = {
      {"on", guarded<api_on>},
      {"raise", guarded<api_raise>},
      {"set", guarded<api_set>},
      {"get", guarded<api_get>},
      {"parameter", guarded<api_parameter>},
      {"active", guarded<api_active>},
      {"time", guarded<api_time>},
      {"log", guarded<api_log>},
      {nullptr, nullptr},
  };
  lua_newtable(lua);
  luaL_setfuncs(lua, functions, 0);
  lua_setglobal(lua, "footfall");
}

}  // namespace footfall::behaviors
