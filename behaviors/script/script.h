// Lua 5.4 for code that is not realtime: functions named in a behavior's `call:`, and event
// handlers. The only use of Lua. A script sees a snapshot of the robot and answers with events to
// raise and parameters to set; it never accesses the tick. To be called from a thread that may
// wait.
//
// Available to scripts: Lua's base, string, table, math, utf8 and coroutine libraries without
// functions that load code, and the table `footfall`:
//   footfall.on(PATTERN, function(event) ... end)   handles events, matched like `on:`
//   footfall.raise(EVENT)      footfall.set(PARAMETER, NUMBER or {NUMBER, ...})
//   footfall.get(SIGNAL)       footfall.parameter(NAME)     footfall.time()
//   footfall.active(STATE)     footfall.log(TEXT)
// `pairs` iterates in sorted order and `math.random` is seeded by the run, so that runs are
// reproducible.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/compiled/script_limits.h"
#include "behaviors/expression/parameter.h"

namespace footfall::behaviors {

struct Behavior;

// Permissions of scripts beyond computing.
struct ScriptAccess {
  bool files = false;      // io.open etc., os.remove, os.rename
  bool processes = false;  // io.popen, os.execute
};

struct ScriptSettings {
  ScriptAccess access;
  std::uint64_t seed = 0;  // seed of math.random
  ScriptLimits limits{};
  std::size_t memory = 64U * 1024U * 1024U;  // bytes, limit of all memory of the script
};

// The robot as seen by a script; valid for the duration of a call.
struct ScriptView {
  const Behavior* behavior = nullptr;
  const double* signals = nullptr;
  const double* parameters = nullptr;
  const std::uint8_t* active = nullptr;  // by state
  double time = 0.0;                     // s
};

// Result of a call; messages are texts for the log, errors begin with `script: `.
struct ScriptAnswer {
  std::vector<int> events;
  std::vector<SlotValue> edits;
  std::vector<std::string> messages;
};

// Position and reason of a script error; line 0: unknown.
struct ScriptError {
  int line = 0;
  std::string text;
  std::string file = {};  // as load() was told; empty: it was not
};

class Script {
 public:
  // Throws std::bad_alloc if Lua cannot be created.
  explicit Script(const ScriptSettings& settings);
  ~Script();
  Script(const Script&) = delete;
  Script& operator=(const Script&) = delete;

  // Runs a file's text, which defines functions and handlers. False and the reason on failure.
  // `name`: of the file, for messages.
  bool load(const std::string& text, ScriptError& error, const std::string& name = {});
  // Global functions defined by the files, sorted, and the patterns of footfall.on in order.
  std::vector<std::string> functions() const;
  const std::vector<std::string>& patterns() const;

  // Calls a global function. False if it failed: the reason is the last message, and requests made
  // before the failure are dropped.
  bool call(const std::string& function, const ScriptView& view, ScriptAnswer& answer);
  // Calls the handlers whose pattern matches the event, in the order of footfall.on.
  bool handle(std::string_view event, const ScriptView& view, ScriptAnswer& answer);

  // From any thread: what runs ends with its next instruction, nothing begins any more, and the
  // view of a call is not looked at after this.
  void stop() noexcept;
  bool stopped() const noexcept;
  const ScriptSettings& settings() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::behaviors
