// The statechart of a behavior alone, without robot: which states are active after which event.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

// One step of a script: a delay or an event.
struct TraceStep {
  double after = -1.0;  // s; negative: an event
  std::string event;
};

// `[{after: 100 ms}, {event: t2}]`; nothing and errors if it is no such list.
std::optional<std::vector<TraceStep>> load_trace_script(const std::string& path,
                                                        core::Diagnostics& diagnostics);
std::optional<std::vector<TraceStep>> load_trace_script_text(std::string_view text,
                                                             const std::string& name,
                                                             core::Diagnostics& diagnostics);
// `t1,t2` as steps.
std::vector<TraceStep> trace_events(std::string_view names);

// One sentence for each event of the steps that the behavior neither declares nor listens to, and
// that is none of the engine's own (contact.*, fault.*, ...).
std::vector<std::string> unknown_events(const Behavior& behavior,
                                        const std::vector<TraceStep>& steps);

// Writes one JSON line for the initial configuration and one after each event:
// {"event":"t1","active":["b1","c1"]}. Time stands still at events and runs through delays, with
// the robot's rate, or 1 kHz without a robot; signals stay 0.
void trace(const Behavior& behavior, const std::vector<TraceStep>& steps, std::ostream& out);

}  // namespace footfall::behaviors
