// Values of expressions before a run: from parameters alone, without measurements. Load time only.
#pragma once

#include <optional>
#include <vector>

#include "behaviors/compiled/behavior.h"

namespace footfall::behaviors {

// Inputs that an expression's value depends on.
struct Dependence {
  bool measured = false;        // signals, clocks, active states
  bool entry = false;           // start value of the reference
  bool variable = false;        // a parameter set by an action
  std::vector<int> parameters;  // indices into Behavior::parameters
  // Constant over every run, unless a parameter is edited.
  bool fixed() const { return !measured && !entry && !variable; }
};

Dependence dependence_of(const Behavior& behavior, int expression);

// Values of expressions in the first tick: parameters at their values unless changed here, signals
// and clocks at 0.
class StaticValues {
 public:
  explicit StaticValues(const Behavior& behavior);

  std::vector<double>& parameters() { return parameters_; }
  // nullopt if the expression is -1 or its value is not finite. `entry`: start value of every axis
  // of the reference.
  std::optional<double> of(int expression, double entry = 0.0) const;

 private:
  const Behavior& behavior_;
  std::vector<double> parameters_;
  std::vector<std::int64_t> entry_ticks_;
  std::vector<std::uint8_t> active_;
};

}  // namespace footfall::behaviors
