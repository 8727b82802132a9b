// Lua 5.4 for what is not realtime: functions that a behavior's `call:` names, and handlers of
// events. The only door to Lua. A script sees a snapshot of the robot and answers with events to
// raise and parameters to set; it never touches the tick. Call it from a thread that may wait.
//
// What a script may use: Lua's base, string, table, math, utf8 and coroutine libraries without the
// parts that load code, and the table `footfall`:
//   footfall.on(PATTERN, function(event) ... end)   handles events, as `on:` matches them
//   footfall.raise(EVENT)      footfall.set(PARAMETER, NUMBER or {NUMBER, ...})
//   footfall.get(SIGNAL)       footfall.parameter(NAME)     footfall.time()
//   footfall.active(STATE)     footfall.log(TEXT)
// `pairs` goes in sorted order and `math.random` from the run's seed, so that runs repeat.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/expression/parameter.h"

namespace footfall::behaviors {

struct Behavior;

// What a run grants beyond computing.
struct ScriptAccess {
  bool files = false;      // io.open and friends, os.remove, os.rename
  bool processes = false;  // io.popen, os.execute
};

struct ScriptSettings {
  ScriptAccess access;
  std::uint64_t seed = 0;                    // of math.random
  std::int64_t instructions = 10'000'000;    // of the virtual machine, in one call
  std::size_t memory = 64U * 1024U * 1024U;  // bytes, of everything that it holds
};

// The robot as a script sees it; valid for the duration of a call.
struct ScriptView {
  const Behavior* behavior = nullptr;
  const double* signals = nullptr;
  const double* parameters = nullptr;
  const std::uint8_t* active = nullptr;  // by state
  double time = 0.0;                     // s
};

// What a call wants; messages are texts for the log, `script: ` before an error.
struct ScriptAnswer {
  std::vector<int> events;
  std::vector<SlotValue> edits;
  std::vector<std::string> messages;
};

// Where and why a script failed; line 0: no line.
struct ScriptError {
  int line = 0;
  std::string text;
};

class Script {
 public:
  // Throws std::bad_alloc if Lua cannot start.
  explicit Script(const ScriptSettings& settings);
  ~Script();
  Script(const Script&) = delete;
  Script& operator=(const Script&) = delete;

  // Runs a file's text, which defines functions and handlers. False and the reason otherwise.
  bool load(const std::string& text, ScriptError& error);
  // Global functions that the files defined, sorted, and the patterns of footfall.on in order.
  std::vector<std::string> functions() const;
  const std::vector<std::string>& patterns() const;

  // Calls a global function; false: it failed (the reason is the last message). What it asked for
  // before failing is dropped.
  bool call(const std::string& function, const ScriptView& view, ScriptAnswer& answer);
  // Calls the handlers whose pattern matches the event, in the order of footfall.on.
  bool handle(std::string_view event, const ScriptView& view, ScriptAnswer& answer);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::behaviors
