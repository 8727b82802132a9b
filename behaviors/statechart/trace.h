// Runs the statechart of a behavior without robot and reports the active states after each event.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

// One step of a trace script: a delay or an event.
struct TraceStep {
  double after = -1.0;  // s; negative: an event
  std::string event;
  bool shown = false;  // a delay that prints a line
};

// Loads `[{after: 100 ms}, {event: t2}]`; nullopt and errors if malformed.
std::optional<std::vector<TraceStep>> load_trace_script(const std::string& path,
                                                        core::Diagnostics& diagnostics);
std::optional<std::vector<TraceStep>> load_trace_script_text(std::string_view text,
                                                             const std::string& name,
                                                             core::Diagnostics& diagnostics);
// Converts `t1,t2` to steps.
std::vector<TraceStep> trace_events(std::string_view names);

// One sentence for each event of the steps that the behavior neither declares nor listens to, and
// that the engine does not raise itself (contact.*, fault.*, ...).
std::vector<std::string> unknown_events(const Behavior& behavior,
                                        const std::vector<TraceStep>& steps);

// Writes one JSON line for the initial configuration, one after each event and one after each delay
// that is `shown`: {"event":"t1","active":["b1","c1"]}; without an event it is null. Time advances
// only during delays, at the robot's rate, or 1 kHz without a robot; signals stay 0.
void trace(const Behavior& behavior, const std::vector<TraceStep>& steps, std::ostream& out);

}  // namespace footfall::behaviors
