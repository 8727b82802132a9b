// Lua's state, its limits and its calls; see script.h. Debian's C++ build of Lua raises errors as
// exceptions, so that C++ objects are destroyed during unwinding.
#include "behaviors/script/script.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <lua.hpp>
#include <new>
#include <utility>

#include "behaviors/compiled/chart.h"
#include "behaviors/script/state.h"
#include "behaviors/script/watched.h"

namespace footfall::behaviors {
namespace {

constexpr int kHookInterval = 1000;  // instructions between two checks of the budget
const char kStateKey = 0;            // its address is the registry key

// Lua allocator with a limit.
void* allocate(void* user, void* old, std::size_t old_size, std::size_t size) {
  auto& state = *static_cast<ScriptState*>(user);
  const std::size_t held = old == nullptr ? 0 : old_size;
  if (size == 0) {
    std::free(old);
    state.memory_used -= held;
    return nullptr;
  }
  if (size > held && state.memory_used - held + size > state.settings.memory) return nullptr;
  void* block = std::realloc(old, size);
  if (block != nullptr) state.memory_used += size - held;
  return block;
}

// Once the budget is used up every instruction fails, so that a script's own pcall cannot continue.
void count_instructions(lua_State* lua, lua_Debug*) {
  ScriptState& state = state_of(lua);
  state.instructions_left -= kHookInterval;
  if (state.instructions_left > 0 && !state.stopped) return;
  state.instructions_left = 0;
  lua_sethook(lua, count_instructions, LUA_MASKCOUNT, 1);
  luaL_error(lua, "stopped: it ran longer than its instructions allow");
}

constexpr std::string_view kNoName = "script";  // of a text without a file

// Parses `NAME:12: text`, the format of Lua's messages.
ScriptError split_message(const char* message) {
  ScriptError error{0, message == nullptr ? "unknown error" : message};
  for (std::size_t colon = error.text.find(':'); colon != std::string::npos;
       colon = error.text.find(':', colon + 1)) {
    char* end = nullptr;
    const long line = std::strtol(error.text.c_str() + colon + 1, &end, 10);
    if (line <= 0 || *end != ':') continue;
    error.line = static_cast<int>(line);
    error.file = error.text.substr(0, colon);
    if (error.file == kNoName) error.file.clear();
    const auto skip = static_cast<std::size_t>(end - error.text.c_str());
    error.text.erase(0, std::min(error.text.size(), skip + 2));
    break;
  }
  return error;
}

// Makes a text with a place of any error: `error({code = 7})` has neither.
int describe(lua_State* lua) {
  if (lua_type(lua, 1) == LUA_TSTRING) return 1;
  luaL_where(lua, 2);  // 1 is error() itself
  // The words of the value's own `__tostring`, which may fail itself.
  if (luaL_getmetafield(lua, 1, "__tostring") != LUA_TNIL) {
    lua_pushvalue(lua, 1);
    if (lua_pcall(lua, 1, 1, 0) == LUA_OK && lua_type(lua, -1) == LUA_TSTRING) {
      lua_concat(lua, 2);
      return 1;
    }
    lua_pop(lua, 1);
  }
  lua_pushfstring(lua, "an error that is no text but a %s", luaL_typename(lua, 1));
  lua_concat(lua, 2);
  return 1;
}

// As `lua` does: no byte order mark, and no `#!` line; the lines keep their numbers.
std::string_view without_head(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  if (!text.starts_with('#')) return text;
  const std::size_t end = text.find('\n');
  return end == text.npos ? std::string_view() : text.substr(end);
}

// What run_protected() does, for run_inside().
struct Inside {
  const std::function<int()>& push;  // a function and its arguments, whose number it returns
  int result = LUA_OK;
  ScriptError error{};
};

// Runs the function that `push` puts on the stack.
int run_inside(lua_State* lua) {
  auto& inside = *static_cast<Inside*>(lua_touserdata(lua, 1));
  lua_pushcfunction(lua, describe);
  const int arguments = inside.push();
  inside.result = arguments < 0 ? LUA_ERRSYNTAX : lua_pcall(lua, arguments, 0, 2);
  if (inside.result != LUA_OK) inside.error = split_message(lua_tostring(lua, -1));
  return 0;
}

// Runs the function that `push` puts on the stack, with a new budget. `push` may fail like the
// function itself (a script may give its globals a metamethod, or have used up its memory), so it
// runs inside too: an error outside of any protected call ends the process.
bool run_protected(ScriptState& state, const std::function<int()>& push, ScriptError& error) {
  state.instructions_left = state.settings.limits.instructions;
  lua_sethook(state.lua, count_instructions, LUA_MASKCOUNT, kHookInterval);
  Inside inside{push};
  lua_pushcfunction(state.lua, run_inside);
  lua_pushlightuserdata(state.lua, &inside);
  const int outside = lua_pcall(state.lua, 1, 0, 0);
  lua_sethook(state.lua, nullptr, 0, 0);
  if (outside != LUA_OK) {
    inside.result = outside;
    inside.error = split_message(lua_tostring(state.lua, -1));
    lua_settop(state.lua, 0);
  }
  error = std::move(inside.error);
  if (inside.result == LUA_ERRMEM)
    error.text = "stopped: it needs more memory than a script may have";
  return inside.result == LUA_OK;
}

int open_protected(lua_State* lua) {
  open_libraries(lua, state_of(lua).settings);
  open_footfall(lua);
  return 0;
}

// Lists the names that exist before any file is loaded.
int list_globals(lua_State* lua, std::vector<std::string>& names, bool functions_only) {
  lua_pushglobaltable(lua);
  lua_pushnil(lua);
  while (lua_next(lua, -2) != 0) {
    const bool wanted = !functions_only || lua_isfunction(lua, -1);
    if (wanted && lua_type(lua, -2) == LUA_TSTRING) names.emplace_back(lua_tostring(lua, -2));
    lua_pop(lua, 1);
  }
  lua_pop(lua, 1);
  std::sort(names.begin(), names.end());
  return static_cast<int>(names.size());
}

}  // namespace

struct Script::Impl {
  ScriptState state;
  std::vector<std::string> built_in;

  // The answer of a call counts only if the call succeeds.
  bool finish(bool good, const ScriptError& error, ScriptAnswer& out, ScriptAnswer& answer) {
    state.view = nullptr;
    state.answer = nullptr;
    out.messages.insert(out.messages.end(), answer.messages.begin(), answer.messages.end());
    if (good) {
      out.events.insert(out.events.end(), answer.events.begin(), answer.events.end());
      out.edits.insert(out.edits.end(), answer.edits.begin(), answer.edits.end());
    } else {
      const std::string number = std::to_string(error.line);
      const std::string line = error.line <= 0      ? ""
                               : error.file.empty() ? "line " + number + ": "
                                                    : error.file + ", line " + number + ": ";
      out.messages.push_back("script error: " + line + error.text);
    }
    return good;
  }
};

ScriptState& state_of(lua_State* lua) {
  lua_rawgetp(lua, LUA_REGISTRYINDEX, &kStateKey);
  auto* state = static_cast<ScriptState*>(lua_touserdata(lua, -1));
  lua_pop(lua, 1);
  return *state;
}

Script::Script(const ScriptSettings& settings) : impl_(std::make_unique<Impl>()) {
  ScriptState& state = impl_->state;
  state.settings = settings;
  state.lua = lua_newstate(allocate, &state);
  if (state.lua == nullptr) throw std::bad_alloc();
  lua_pushlightuserdata(state.lua, &state);
  lua_rawsetp(state.lua, LUA_REGISTRYINDEX, &kStateKey);
  lua_pushcfunction(state.lua, open_protected);
  if (lua_pcall(state.lua, 0, 0, 0) != LUA_OK) {
    lua_close(state.lua);
    throw std::bad_alloc();
  }
  list_globals(state.lua, impl_->built_in, false);
}

// A program that the script left running is waited for when its pipe is closed.
Script::~Script() {
  const std::shared_ptr<Impl> impl = std::move(impl_);
  const auto close = [impl] { lua_close(impl->state.lua); };
  const ScriptAccess& access = impl->state.settings.access;
  if (!access.files && !access.processes) {
    close();
  } else {
    core::run_watched(close, watch_limits(impl->state.settings.limits));
  }
}

void Script::stop() noexcept {
  const std::lock_guard lock(impl_->state.view_in_use);
  impl_->state.stopped = true;
}

bool Script::stopped() const noexcept { return impl_->state.stopped; }

const ScriptSettings& Script::settings() const noexcept { return impl_->state.settings; }

bool Script::load(const std::string& text, ScriptError& error, const std::string& name) {
  if (stopped()) return false;
  lua_State* lua = impl_->state.lua;
  const std::string_view code = without_head(text);
  const std::string chunk = "=" + (name.empty() ? std::string(kNoName) : name);
  // "t": text only; malformed byte code could crash the interpreter. -1: it does not compile.
  const auto push = [&] {
    return luaL_loadbufferx(lua, code.data(), code.size(), chunk.c_str(), "t") == LUA_OK ? 0 : -1;
  };
  return run_protected(impl_->state, push, error);
}

std::vector<std::string> Script::functions() const {
  std::vector<std::string> names, own;
  list_globals(impl_->state.lua, names, true);
  const auto& known = impl_->built_in;
  std::set_difference(names.begin(), names.end(), known.begin(), known.end(),
                      std::back_inserter(own));
  return own;
}

const std::vector<std::string>& Script::patterns() const { return impl_->state.patterns; }

bool Script::call(const std::string& function, const ScriptView& view, ScriptAnswer& out) {
  if (stopped()) return false;
  ScriptState& state = impl_->state;
  ScriptAnswer answer;
  state.view = &view;
  state.answer = &answer;
  ScriptError error;
  const auto push = [&] {
    lua_getglobal(state.lua, function.c_str());
    return 0;
  };
  const bool good = run_protected(state, push, error);
  return impl_->finish(good, error, out, answer);
}

bool Script::handle(std::string_view event, const ScriptView& view, ScriptAnswer& out) {
  if (stopped()) return false;
  ScriptState& state = impl_->state;
  bool all = true;
  for (std::size_t k = 0; k < state.handlers.size(); ++k) {
    if (!Chart::event_matches(state.patterns[k], event)) continue;
    ScriptAnswer answer;
    state.view = &view;
    state.answer = &answer;
    ScriptError error;
    const auto push = [&] {
      lua_rawgeti(state.lua, LUA_REGISTRYINDEX, state.handlers[k]);
      lua_pushlstring(state.lua, event.data(), event.size());
      return 1;
    };
    const bool good = run_protected(state, push, error);
    all = impl_->finish(good, error, out, answer) && all;
  }
  return all;
}

}  // namespace footfall::behaviors
