// Libraries available to scripts: Lua's own without functions that load code, read a clock or,
// unless the run allows it, access files and processes.
#include <lua.hpp>
#include <string>
#include <string_view>

#include "behaviors/script/state.h"

namespace footfall::behaviors {
namespace {

void remove(lua_State* lua, const char* table, std::initializer_list<const char*> names) {
  lua_getglobal(lua, table);
  for (const char* name : names) {
    lua_pushnil(lua);
    lua_setfield(lua, -2, name);
  }
  lua_pop(lua, 1);
}

// What is not there says why, and what to use instead. Runs must be reproducible bit for bit: no
// clocks, no environment, no code from elsewhere; and scripts must not end the process.
constexpr const char* kNoClock = "runs must repeat: footfall.time() is the time in the run";
constexpr const char* kRepeat = "runs must repeat";
constexpr const char* kText = "use footfall.log(TEXT)";
constexpr const char* kFiles = "name all Lua files in the behavior's `scripts:`";
constexpr const char* kAllowFiles = "footfall run --allow files";
constexpr const char* kAllowProcesses = "footfall run --allow processes";

struct Missing {
  const char* name;
  const char* why;
};

// A function that raises an error: `NAME is not there: WHY`.
constexpr const char* kMissing = R"(
local place, prefix, name, why = ...
place[name] = function() error(prefix .. name .. " is not there: " .. why, 2) end
)";

void say_why(lua_State* lua, const char* table, std::initializer_list<Missing> functions) {
  const bool global = std::string_view(table) == LUA_GNAME;
  for (const auto& [name, why] : functions) {
    if (luaL_loadstring(lua, kMissing) != LUA_OK) lua_error(lua);
    lua_getglobal(lua, table);
    lua_pushstring(lua, global ? "" : (std::string(table) + ".").c_str());
    lua_pushstring(lua, name);
    lua_pushstring(lua, why);
    lua_call(lua, 4, 0);
  }
}

void open_os(lua_State* lua, const ScriptAccess& access) {
  luaL_requiref(lua, LUA_OSLIBNAME, luaopen_os, 1);
  lua_pop(lua, 1);
  say_why(lua, LUA_OSLIBNAME,
          {{"clock", kNoClock},
           {"date", kNoClock},
           {"time", kNoClock},
           {"difftime", kNoClock},
           {"getenv", kRepeat},
           {"setlocale", kRepeat},
           {"exit", "a script cannot end the run"}});
  if (!access.files) {
    say_why(lua, LUA_OSLIBNAME,
            {{"remove", kAllowFiles}, {"rename", kAllowFiles}, {"tmpname", kAllowFiles}});
  }
  if (!access.processes) say_why(lua, LUA_OSLIBNAME, {{"execute", kAllowProcesses}});
}

void open_io(lua_State* lua, const ScriptAccess& access) {
  luaL_requiref(lua, LUA_IOLIBNAME, luaopen_io, 1);
  lua_pop(lua, 1);
  remove(lua, LUA_IOLIBNAME, {"stdin", "stdout", "stderr"});
  // What getmetatable(file) gives: else a script could put a finalizer of its own there.
  luaL_getmetatable(lua, LUA_FILEHANDLE);
  lua_pushliteral(lua, "file");
  lua_setfield(lua, -2, "__metatable");
  lua_pop(lua, 1);
  say_why(lua, LUA_IOLIBNAME,
          {{"read", kRepeat}, {"write", kText}, {"input", kRepeat}, {"output", kText}});
  if (!access.processes) say_why(lua, LUA_IOLIBNAME, {{"popen", kAllowProcesses}});
  if (!access.files) {
    say_why(lua, LUA_IOLIBNAME,
            {{"open", kAllowFiles}, {"lines", kAllowFiles}, {"tmpfile", kAllowFiles}});
  }
}

// Placeholder of a library that is not there; its functions raise an error that says why.
constexpr const char* kGuard = R"(
local name, why, never, instead = ...
_G[name] = setmetatable({}, {__index = function(_, key)
  error(name .. "." .. tostring(key) .. " is not there: " .. (never[key] and instead or why), 2)
end})
)";

// `never`: functions that no permission brings.
void guard(lua_State* lua, const char* name, const char* why,
           std::initializer_list<const char*> never = {}) {
  if (luaL_loadstring(lua, kGuard) != LUA_OK) lua_error(lua);
  lua_pushstring(lua, name);
  lua_pushstring(lua, why);
  lua_newtable(lua);
  for (const char* function : never) {
    lua_pushboolean(lua, 1);
    lua_setfield(lua, -2, function);
  }
  lua_pushstring(lua, kNoClock);
  lua_call(lua, 4, 0);
}

// Sorted iteration, because Lua's own order differs between processes.
constexpr const char* kPairs = R"(
local next, type, sort, rawtype = next, type, table.sort, math.type
function pairs(t)
  local meta = getmetatable(t)
  if meta and meta.__pairs then return meta.__pairs(t) end
  local keys = {}
  for key in next, t do keys[#keys + 1] = key end
  sort(keys, function(a, b)
    local x, y = type(a), type(b)
    if x ~= y then return x < y end
    if x == "number" or x == "string" then return a < b end
    return false
  end)
  local at = 0
  return function()
    repeat
      at = at + 1
      local key = keys[at]
      if key == nil then return nil end
      local value = t[key]
      if value ~= nil then return key, value end
    until false
  end, t, nil
end
)";

// No finalizers: Lua counts no instructions in them, so that one without end could not be stopped,
// and they would run when the script is destroyed.
constexpr const char* kSetMetatable = R"(
local set, type, rawget = setmetatable, type, rawget
function setmetatable(t, meta)
  if type(meta) == "table" and rawget(meta, "__gc") ~= nil then
    error("__gc is not there: nothing is closed by the collector; use <close> variables", 2)
  end
  return set(t, meta)
end
)";

}  // namespace

void open_libraries(lua_State* lua, const ScriptSettings& settings) {
  const luaL_Reg libraries[] = {
      {LUA_GNAME, luaopen_base},        {LUA_TABLIBNAME, luaopen_table},
      {LUA_STRLIBNAME, luaopen_string}, {LUA_MATHLIBNAME, luaopen_math},
      {LUA_UTF8LIBNAME, luaopen_utf8},  {LUA_COLIBNAME, luaopen_coroutine},
  };
  for (const luaL_Reg& library : libraries) {
    luaL_requiref(lua, library.name, library.func, 1);
    lua_pop(lua, 1);
  }
  say_why(lua, LUA_GNAME,
          {{"load", kFiles},
           {"loadfile", kFiles},
           {"dofile", kFiles},
           {"require", kFiles},
           {"collectgarbage", "memory is cleaned up by itself"},
           {"print", kText},
           {"warn", kText}});
  say_why(lua, LUA_STRLIBNAME, {{"dump", kFiles}});
  if (luaL_dostring(lua, kPairs) != LUA_OK) lua_error(lua);
  if (luaL_dostring(lua, kSetMetatable) != LUA_OK) lua_error(lua);
  lua_getglobal(lua, LUA_MATHLIBNAME);
  lua_getfield(lua, -1, "randomseed");
  lua_pushinteger(lua, static_cast<lua_Integer>(settings.seed));
  lua_call(lua, 1, 0);
  lua_pop(lua, 1);
  say_why(lua, LUA_MATHLIBNAME, {{"randomseed", "the run's --seed seeds math.random"}});
  guard(lua, "debug", kRepeat);
  guard(lua, "package", kFiles);
  const ScriptAccess& access = settings.access;
  if (access.files || access.processes) {
    open_os(lua, access);
    open_io(lua, access);
  } else {
    guard(lua, LUA_IOLIBNAME, kAllowFiles);
    guard(lua, LUA_OSLIBNAME, "footfall run --allow files or --allow processes",
          {"clock", "date", "time", "difftime"});
  }
}

}  // namespace footfall::behaviors
