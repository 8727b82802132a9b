// A parameter or gain of a behavior: consecutive values in the machine's flat array.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/units/units.h"

namespace footfall::behaviors {

// A parameter or gain in the flat array Machine::parameters().
struct ParameterInfo {
  std::string name;  // `goal`, `gains.single.swing.kp`
  int slot = 0;      // first value
  int size = 1;
  core::Dimension dimension;
  double min = 0.0, max = 0.0;  // equal: unlimited
  bool live = false;
  std::string doc;
  bool bare = false;      // written without unit: adopts the required dimension
  bool variable = false;  // set by an action: reset at the start of every run, never live
  bool gain = false;      // of a table of gains, of torque loops, or of the estimator
  bool at_start = false;  // taken when the run starts: later values do nothing, never live
  std::vector<std::string> axes{};  // of a gain: names of the values (of a torque loop: joints)
  core::Mark mark{};                // of its name, or of its value in a gain table

  bool has_range() const { return min < max; }
  // Whether it is `torque_loop.TABLE.GAIN`; parameters have no dots in their names.
  bool of_torque_loop() const { return name.starts_with("torque_loop."); }
  bool of_estimator() const { return name.starts_with("estimator."); }
};

// Component index of `x`, `y` or `z` among `size` values; -1 if invalid.
inline int component_of(std::string_view name, int size) {
  const int index = name.size() == 1 ? name[0] - 'x' : -1;
  return index >= 0 && index < size && index < 3 ? index : -1;
}

// Component of a value's last name, `pitch` or `x`: a gain's values have the names of its task's
// axes; -1 if invalid.
inline int component_of(std::string_view name, const ParameterInfo& info) {
  for (std::size_t k = 0; k < info.axes.size(); ++k) {
    if (info.axes[k] == name) return static_cast<int>(k);
  }
  return info.axes.empty() ? component_of(name, info.size) : -1;
}
// The name of one value: `lift_time`, `goal.x`, `gains.single.attitude.kp.pitch`.
inline std::string value_name(const ParameterInfo& info, int component) {
  const auto k = static_cast<std::size_t>(component);
  if (info.size == 1) return info.name;
  if (k < info.axes.size()) return info.name + "." + info.axes[k];
  if (info.size <= 3) return info.name + "." + "xyz"[k];
  return info.name + "[" + std::to_string(component) + "]";
}

// A parameter, or one of its components.
struct ParameterPart {
  int parameter = -1;  // into Behavior::parameters
  int component = -1;  // -1: all
};

// A new value in the flat array, SI.
struct SlotValue {
  int slot = 0;
  double value = 0.0;

  bool operator==(const SlotValue&) const = default;
};

// New values of a parameter or gain by name, or of one of its components (`goal.y`), SI: for use
// without the array, or with a different one.
struct NamedValue {
  std::string name;
  std::vector<double> values;  // all values of the parameter or component
};

}  // namespace footfall::behaviors
