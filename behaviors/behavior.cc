// Look-ups by name, for outside the tick; see behavior.h.
#include "behaviors/behavior.h"

#include <algorithm>

namespace footfall::behaviors {

int Behavior::find_event(std::string_view event) const {
  const auto found = std::find(events.begin(), events.end(), event);
  return found == events.end() ? -1 : static_cast<int>(found - events.begin());
}

int Behavior::find_state(std::string_view state_path) const {
  for (std::size_t s = 0; s < states.size(); ++s) {
    if (states[s].path == state_path) return static_cast<int>(s);
  }
  return -1;
}

int Behavior::find_parameter(std::string_view parameter) const {
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (parameters[k].name == parameter) return static_cast<int>(k);
  }
  return -1;
}

}  // namespace footfall::behaviors
