// A parameter or gain of a behavior: consecutive values in the machine's flat array.
#pragma once

#include <string>
#include <string_view>
#include <vector>

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
  bool gain = false;      // entry of a gain table

  bool has_range() const { return min < max; }
};

// Component index of `x`, `y` or `z` among `size` values; -1 if invalid.
inline int component_of(std::string_view name, int size) {
  const int index = name.size() == 1 ? name[0] - 'x' : -1;
  return index >= 0 && index < size && index < 3 ? index : -1;
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
