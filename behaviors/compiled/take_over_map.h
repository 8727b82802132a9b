// One behavior takes the place of another in a run, between two ticks: which parts of the new one
// go on from which of the old one's. Worked out beside the run; using it allocates nothing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"

namespace footfall::behaviors {

// By index in the old behavior: the index in the new one of what goes on there, -1: nothing does.
struct TakeOverMap {
  // Same dotted path and kind; of a parallel state also the same regions. So the old configuration
  // is one of the new behavior exactly if all its states are here.
  std::vector<int> states;
  std::vector<int> histories;    // by slot: same path, shallow or deep alike
  std::vector<int> transitions;  // same place among those of its state, likewise with `on`, `after`
  std::vector<std::uint8_t> same_after;  // by transition: its deadline stays as it is
  std::vector<int> events;               // same name
  std::vector<int> instances;            // tasks of the same name, type and point
  std::vector<int> planners;             // same name
  std::vector<int> invokes;              // same place among those of its state, same planner
  std::vector<int> signals;              // same name and dimension
  // Whether the states of one configuration weigh alike, so that what is controlled in it has the
  // same index.
  bool same_controls = false;
  // By slot of the new behavior: that of the old one, of a parameter of the same name and
  // dimension, -1: none.
  std::vector<int> slots;
};

// Robots must be the same.
TakeOverMap map_take_over(const Behavior& from, const Behavior& to);

// Whether a state or one around it says `reload: ok`.
bool permits_reload(const Chart& chart, int state);

// Every reason why `to` can never take the place of `from`, each a text for people: another robot,
// no state that permits it, or none of those is in `to`.
std::vector<std::string> reasons_against_take_over(const Behavior& from, const Behavior& to,
                                                   const TakeOverMap& map);

}  // namespace footfall::behaviors
