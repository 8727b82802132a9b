// Bumpless transfer: one behavior replaces another in a run, between two ticks. Maps the parts of
// the old behavior to those of the new one that continue them. Computed outside the tick; using it
// allocates nothing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"

namespace footfall::behaviors {

// By index in the old behavior: index of the corresponding part of the new one, -1: none.
struct TakeOverMap {
  // Same dotted path and kind; for a parallel state also the same regions. The old configuration
  // thus exists in the new behavior exactly if all its states are mapped.
  std::vector<int> states;
  std::vector<int> histories;            // by slot: same path, both shallow or both deep
  std::vector<int> transitions;          // same position in their state, same use of `on`, `after`
  std::vector<std::uint8_t> same_after;  // by transition: its deadline is unchanged
  std::vector<int> events;               // same name
  std::vector<int> instances;            // tasks of the same name, type and point
  std::vector<int> internals;            // internal forces of the same name
  std::vector<int> planners;             // same name
  std::vector<int> invokes;              // same position among those of its state, same planner
  std::vector<int> signals;              // same name and dimension
  // Whether the states of each configuration have equal control weights, so that the control index
  // is the same.
  bool same_controls = false;
  // By slot of the new behavior: the old slot of a parameter of the same name and dimension, -1:
  // none.
  std::vector<int> slots;
};

// The robots must be the same.
TakeOverMap map_take_over(const Behavior& from, const Behavior& to);

// Whether a state or one of its ancestors has `reload: ok`.
bool permits_reload(const Chart& chart, int state);

// All reasons why `to` can never replace `from`, as text: another robot, no state that permits it,
// or none of those exists in `to`.
std::vector<std::string> reasons_against_take_over(const Behavior& from, const Behavior& to,
                                                   const TakeOverMap& map);

}  // namespace footfall::behaviors
