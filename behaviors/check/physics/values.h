// What expressions are worth before a run: on parameters alone, with nothing measured yet. Load
// time only.
#pragma once

#include <optional>
#include <vector>

#include "behaviors/compiled/behavior.h"

namespace footfall::behaviors {

// What an expression's value hangs on besides numbers.
struct Dependence {
  bool measured = false;        // signals, clocks, active states
  bool entry = false;           // what the reference started from
  bool variable = false;        // a parameter that an action sets
  std::vector<int> parameters;  // indices into Behavior::parameters
  // The same at every tick of every run, if nobody edits a parameter.
  bool fixed() const { return !measured && !entry && !variable; }
};

Dependence dependence_of(const Behavior& behavior, int expression);

// Values of expressions in the first tick: parameters at their values unless changed here, signals
// and clocks at 0.
class StaticValues {
 public:
  explicit StaticValues(const Behavior& behavior);

  std::vector<double>& parameters() { return parameters_; }
  // Nothing if the expression is -1 or its value is not finite. `entry`: what every axis of the
  // reference started from.
  std::optional<double> of(int expression, double entry = 0.0) const;

 private:
  const Behavior& behavior_;
  std::vector<double> parameters_;
  std::vector<std::int64_t> entry_ticks_;
  std::vector<std::uint8_t> active_;
};

}  // namespace footfall::behaviors
