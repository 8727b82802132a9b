// Loads and calls under watch; see watched.h.
#include "behaviors/script/watched.h"

#include <algorithm>
#include <utility>

namespace footfall::behaviors {

const char* const kGaveUp =
    "stopped: a function of Lua's library does not end (string patterns, sorting, files, "
    "programs); when it is stopped depends on the machine, so such a run does not repeat";

namespace {

// An instruction takes 10 to 50 ns; at least four times that for a slow machine.
constexpr double kInstruction = 200e-9;  // s
constexpr double kLibrary = 2.0;         // s, for functions of Lua's library

// The bound in wall time is for calls that block and use no processor time (programs, pipes), and
// must not end those that only wait for a processor. A call that gets a tenth of one may use its
// whole deadline; a call of 10 ms ends in time, even where the thread gets one part in a hundred.
constexpr double kWall = 10.0;      // times the processor time
constexpr double kLeastWall = 1.0;  // s

}  // namespace

core::WatchLimits watch_limits(const ScriptLimits& call) {
  core::WatchLimits limits;
  limits.cpu = call.deadline > 0.0
                   ? call.deadline
                   : kLibrary + kInstruction * static_cast<double>(call.instructions);
  limits.wall = std::max(kLeastWall, kWall * limits.cpu);
  return limits;
}

bool load_watched(const std::shared_ptr<Script>& script, const std::string& text,
                  ScriptError& error, const std::string& name) {
  struct Result {
    bool good = false;
    ScriptError error;
  };
  const auto result = std::make_shared<Result>();
  const auto work = [script, text, name, result] {
    result->good = script->load(text, result->error, name);
  };
  if (!core::run_watched(work, watch_limits(script->settings().limits))) {
    script->stop();
    error = {0, kGaveUp};
    return false;
  }
  error = std::move(result->error);
  return result->good;
}

bool call_watched(const std::shared_ptr<Script>& script, const std::string& function,
                  const ScriptView& view, ScriptAnswer& answer) {
  struct Result {
    bool good = false;
    ScriptAnswer answer;
  };
  const auto result = std::make_shared<Result>();
  const auto work = [script, function, view, result] {
    result->good = script->call(function, view, result->answer);
  };
  if (!core::run_watched(work, watch_limits(script->settings().limits))) {
    script->stop();
    answer.messages.emplace_back(std::string("script error: ") + kGaveUp);
    return false;
  }
  answer = std::move(result->answer);
  return result->good;
}

}  // namespace footfall::behaviors
