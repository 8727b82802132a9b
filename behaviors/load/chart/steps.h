// Loader steps that build the chart: states, events, transitions, planners, scripts. Load time
// only.
#pragma once

#include "behaviors/load/context.h"

namespace footfall::behaviors {

void load_states(LoadContext& context);       // states.cc
void load_events(LoadContext& context);       // events.cc
void load_scripts(LoadContext& context);      // scripts.cc
void load_planners(LoadContext& context);     // planners.cc
void load_transitions(LoadContext& context);  // transitions.cc
void load_invokes(LoadContext& context);      // invokes.cc
void finish_events(LoadContext& context);     // events.cc

// Loads the events of a transition's `on` into Chart::patterns (events.cc).
void load_patterns(LoadContext& context, int state, const core::YamlNode& on, int transition);
// Appends a list of actions (on_entry, on_exit, do) to the chart (actions.cc).
Range load_actions(LoadContext& context, const core::YamlNode& node, int state);
// Loads the targets of a transition, `initial` or `default` (states.cc).
Range load_targets(LoadContext& context, int from, const core::YamlNode& node);

}  // namespace footfall::behaviors
