// Between the words of a request and the numbers of a behavior.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/edits/door.h"

namespace footfall_lcm {
class request_t;
}

namespace footfall::engine {

// What of a behavior can be asked for.
struct LiveNames {
  explicit LiveNames(const behaviors::Behavior& behavior);

  std::vector<int> parameters;  // live ones, into Behavior::parameters
  std::vector<int> events;      // that may come from outside, into Behavior::events
  std::vector<std::string> parameter_names, event_names;
  std::size_t value_count = 0;  // of all live parameters
};

// The batch that an EDIT asks for. What has no number in the behavior is left out, with a text for
// people in `reasons`; all else is for reasons_against() to judge.
EditBatch read_edit(const behaviors::Behavior& behavior, const LiveNames& names,
                    const footfall_lcm::request_t& request, std::vector<std::string>& reasons);

// `lift_time = 150 ms, goal.y = 0.5 m over 100 ms, raise go`; `ramp`: s, of the values.
std::string change_text(const behaviors::Behavior& behavior, const EditBatch& batch, double ramp);

// At most so many texts, none long, and how many are missing.
std::vector<std::string> shortened(std::vector<std::string> reasons);

}  // namespace footfall::engine
