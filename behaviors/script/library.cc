// Libraries available to scripts: Lua's own without functions that load code, read a clock or,
// unless the run allows it, access files and processes.
#include <lua.hpp>

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

void open_os(lua_State* lua, const ScriptAccess& access) {
  luaL_requiref(lua, LUA_OSLIBNAME, luaopen_os, 1);
  lua_pop(lua, 1);
  // Runs must be reproducible bit for bit: no clocks, no environment; and scripts must not end the
  // process.
  remove(lua, LUA_OSLIBNAME, {"clock", "date", "time", "getenv", "setlocale", "exit", "difftime"});
  if (!access.files) remove(lua, LUA_OSLIBNAME, {"remove", "rename", "tmpname"});
  if (!access.processes) remove(lua, LUA_OSLIBNAME, {"execute"});
}

// Placeholder of a library that is not allowed: using it raises an error that states how to allow
// it.
constexpr const char* kGuard = R"(
local name, why = ...
_G[name] = setmetatable({}, {__index = function(_, key)
  error(name .. "." .. key .. " is not allowed here: " .. why, 2)
end})
)";

void guard(lua_State* lua, const char* name, const char* why) {
  if (luaL_loadstring(lua, kGuard) != LUA_OK) lua_error(lua);
  lua_pushstring(lua, name);
  lua_pushstring(lua, why);
  lua_call(lua, 2, 0);
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
  remove(lua, LUA_GNAME, {"load", "loadfile", "dofile", "collectgarbage", "print", "warn"});
  remove(lua, LUA_STRLIBNAME, {"dump"});
  if (luaL_dostring(lua, kPairs) != LUA_OK) lua_error(lua);
  lua_getglobal(lua, LUA_MATHLIBNAME);
  lua_getfield(lua, -1, "randomseed");
  lua_pushinteger(lua, static_cast<lua_Integer>(settings.seed));
  lua_call(lua, 1, 0);
  lua_pop(lua, 1);
  remove(lua, LUA_MATHLIBNAME, {"randomseed"});
  const ScriptAccess& access = settings.access;
  if (access.files || access.processes) {
    open_os(lua, access);
    luaL_requiref(lua, LUA_IOLIBNAME, luaopen_io, 1);
    lua_pop(lua, 1);
    remove(lua, LUA_IOLIBNAME, {"stdin", "stdout", "stderr", "read", "write", "input", "output"});
    if (!access.processes) remove(lua, LUA_IOLIBNAME, {"popen"});
    if (!access.files) remove(lua, LUA_IOLIBNAME, {"open", "lines", "tmpfile"});
  } else {
    guard(lua, LUA_IOLIBNAME, "footfall run --allow files");
    guard(lua, LUA_OSLIBNAME, "footfall run --allow files or --allow processes");
  }
}

}  // namespace footfall::behaviors
