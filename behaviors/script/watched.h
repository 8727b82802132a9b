// Scripts outside of a run's own thread for them: a function of Lua's library that does not end
// (a pattern that backtracks for hours) stops neither `check` nor a scenario.
#pragma once

#include <memory>
#include <string>

#include "behaviors/script/script.h"
#include "core/realtime/watched_thread.h"

namespace footfall::behaviors {

// What a call may take: beyond its instructions only functions of Lua's library need this long.
core::WatchLimits watch_limits(const ScriptLimits& limits);

// As Script::load() and Script::call(), on a thread of its own. If nothing comes back within the
// limits the script is stopped: false, and the reason says so.
bool load_watched(const std::shared_ptr<Script>& script, const std::string& text,
                  ScriptError& error, const std::string& name = {});
bool call_watched(const std::shared_ptr<Script>& script, const std::string& function,
                  const ScriptView& view, ScriptAnswer& answer);

// "... whether it ends in time depends on the machine, so such a run does not repeat".
extern const char* const kGaveUp;

}  // namespace footfall::behaviors
