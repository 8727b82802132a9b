// Which controls a statechart puts in force, and which follow each other. Load time only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"

namespace footfall::behaviors {

// A path of an atomic state in whose configuration each control is in force, by index into
// Behavior::controls; for the control that a contact transition loads toward, of the state that
// declares it. Controls that no configuration has are left out.
std::map<int, int> controlling_states(const Behavior& behavior);

// A transition that puts another control in force than the one before it.
struct ControlChange {
  int transition = 0;  // into Behavior::transitions
  int from = 0;        // into Behavior::controls
  int to = 0;
  std::vector<int> entered;  // states that it enters, and that are still active after the tick
};

// Every transition in every configuration that it may start from. States that are left in the tick
// they were entered (final children whose `done` is listened to, event-less transitions without
// condition) are passed through. Left out: the way to the safe state, the end of the run, history.
std::vector<ControlChange> control_changes(const Behavior& behavior);

}  // namespace footfall::behaviors
