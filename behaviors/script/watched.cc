// Loads and calls under watch; see watched.h.
#include "behaviors/script/watched.h"

#include <utility>

namespace footfall::behaviors {

const char* const kGaveUp =
    "stopped: a function of Lua's library does not end (string patterns, sorting, files, "
    "programs); when it is stopped depends on the machine, so such a run does not repeat";

core::WatchLimits watch_limits(const ScriptLimits& call) {
  // An instruction takes 10 to 50 ns; ten times that for a slow machine with other work.
  constexpr double kInstruction = 200e-9;  // s
  core::WatchLimits limits;
  limits.cpu = call.deadline > 0.0 ? call.deadline
                                   : 2.0 + kInstruction * static_cast<double>(call.instructions);
  limits.wall = 5.0 * limits.cpu;
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
