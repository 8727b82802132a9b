// Control configurations of a statechart and their possible successors. Load time only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"

namespace footfall::behaviors {

// For each control (index into Behavior::controls), the path of an atomic state in one of its
// configurations; for the control that a contact transition loads toward, of the state that
// declares it. Controls without configuration are omitted.
std::map<int, int> controlling_states(const Behavior& behavior);

// The atomic state in which a run begins, before any transition (the last one of parallel regions),
// and its control. No history, no states: -1.
struct FirstControl {
  int state = -1;
  int control = -1;
};
FirstControl first_control(const Behavior& behavior);

// A transition that changes the control.
struct ControlChange {
  int transition = 0;  // into Behavior::transitions
  int from = 0;        // into Behavior::controls
  int to = 0;
  int domain = 0;            // what was active strictly below this state is exited
  std::vector<int> entered;  // states entered that are still active after the tick
};

// All transitions in all their possible source configurations. States exited in the tick in which
// they were entered (final children whose `done` is awaited, event-less transitions without
// condition) are passed through. Excluded: transitions to the safe state, the end of the run,
// history.
std::vector<ControlChange> control_changes(const Behavior& behavior);

}  // namespace footfall::behaviors
