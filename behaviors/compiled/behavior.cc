// Look-ups by name, not for the tick; see behavior.h.
#include "behaviors/compiled/behavior.h"

#include <algorithm>
#include <charconv>

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

int Behavior::parameter_of_slot(int slot) const {
  const auto owner = std::ranges::find_if(parameters, [slot](const ParameterInfo& info) {
    return slot >= info.slot && slot < info.slot + info.size;
  });
  return owner == parameters.end() ? -1 : static_cast<int>(owner - parameters.begin());
}

ParameterPart Behavior::find_parameter_part(std::string_view text) const {
  const int whole = find_parameter(text);
  const bool numbered = text.ends_with(']');
  const std::size_t end = text.rfind(numbered ? '[' : '.');
  if (whole >= 0 || end == std::string_view::npos) return {whole, -1};
  const int parameter = find_parameter(text.substr(0, end));
  if (parameter < 0) return {};
  const ParameterInfo& info = parameters[static_cast<std::size_t>(parameter)];
  const std::string_view part = text.substr(end + 1);
  int component = -1;
  if (numbered) {
    const char* const last = part.data() + part.size() - 1;
    const auto [stop, error] = std::from_chars(part.data(), last, component);
    if (error != std::errc() || stop != last || component >= info.size) component = -1;
  } else {
    component = component_of(part, info);
  }
  return component < 0 ? ParameterPart{} : ParameterPart{parameter, component};
}

}  // namespace footfall::behaviors
