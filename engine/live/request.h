// Converts requests (with names) to edits of a behavior (with indices).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/edits/door.h"

namespace footfall_lcm {
class request_t;
}

namespace footfall::engine {

// The items of a behavior that requests may name.
struct LiveNames {
  explicit LiveNames(const behaviors::Behavior& behavior);

  std::vector<int> parameters;  // live ones, into Behavior::parameters
  std::vector<int> events;      // events allowed from outside, into Behavior::events
  std::vector<std::string> parameter_names, event_names;
  std::size_t value_count = 0;  // number of values of all live parameters
};

// The batch requested by an EDIT. Unknown names are omitted and reported as text in `reasons`; all
// other checks are made by reasons_against().
EditBatch read_edit(const behaviors::Behavior& behavior, const LiveNames& names,
                    const footfall_lcm::request_t& request, std::vector<std::string>& reasons);

// `lift_time = 150 ms, goal.y = 0.5 m over 100 ms, raise go`; `ramp`: s, of the values.
std::string change_text(const behaviors::Behavior& behavior, const EditBatch& batch, double ramp);

// Limits the number and length of texts; the last one gives the number of omitted texts.
std::vector<std::string> shortened(std::vector<std::string> reasons);

}  // namespace footfall::engine
